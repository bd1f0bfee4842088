#include "core/motion/smoothing/smoothness_search.h"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace glidelab::core {
namespace {

constexpr double kTauRatio = 1.5;
constexpr double kLeastTau = 0.3;      // steps: interpolation
constexpr double kGreatestTau = 0.5;   // of the longest part
constexpr double kRateWidth = 3.0;     // of the prior, over the longest part
constexpr double kWidest = 5.0;        // largest standard deviation of k, over the longest part
constexpr double kFastest = 0.3;       // rate, per step
constexpr double kGrowing = 10.0;      // e-folds over the longest part
constexpr double kMostDeficit = 60.0;  // of -2 log
constexpr int kBrentBits = 8;
/// Prior odds that a motion follows the process without its noise. With these odds the bands of simulated gliders hold
/// (docs/evidence/peers.md).
constexpr double kSpike = 3.0;

double least_tau(const MotionParts& parts) {
  return kLeastTau * parts.step_s;
}
double greatest_tau(const MotionParts& parts) {
  return std::max(kGreatestTau * parts.longest_s, 2.0 * least_tau(parts));
}

/// Prior density of k: Cauchy.
double prior_density(const MotionParts& parts, double rate_1_s) {
  const double scale = kRateWidth / parts.longest_s;
  return 1.0 / (std::numbers::pi * scale * (1.0 + std::pow(rate_1_s / scale, 2)));
}

/// Finds k by parabolas through three rates, a standard deviation apart.
template <int N>
AtTau best_rate(const PartedMotion<N>& motion, Smoothness how, double rate_1_s, double width_1_s) {
  constexpr int kMost = 12;
  constexpr double kSettled = 0.1;  // standard deviations
  const MotionParts& parts = motion.parts();
  const double widest = kWidest / parts.longest_s;
  const double low = -kGrowing / parts.longest_s, high = std::max(kFastest / parts.step_s, 2.0 * widest);
  const auto value = [&](double rate) {
    how.rate_1_s = rate;
    return motion.minus_two_log_likelihood(how) -
           2.0 * std::log(prior_density(parts, rate) / prior_density(parts, 0.0));
  };
  double width = std::min(width_1_s, widest), middle = std::clamp(rate_1_s, low + width, high - width);
  double at_middle = value(middle);
  for (int pass = 0; pass < kMost; ++pass) {
    const double below = value(middle - width), above = value(middle + width);
    const double curvature = (above - 2.0 * at_middle + below) / (width * width);
    const double slope = 0.5 * (above - below) / width;
    double step = curvature > 0.0 ? -slope / curvature : above < below ? 3.0 * width : -3.0 * width;
    step = std::clamp(step, -4.0 * width, 4.0 * width);
    double next = middle + step;
    double next_width =
        curvature > 0.0 ? std::clamp(std::sqrt(2.0 / curvature), 0.02 * width, 20.0 * width) : 2.0 * width;
    next_width = std::min(next_width, widest);
    next = std::clamp(next, low + next_width, high - next_width);
    const double at_next = value(next);
    const double moved = std::abs(next - middle);
    if (at_next < at_middle) {
      middle = next;
      at_middle = at_next;
    } else if (below < at_middle || above < at_middle) {
      middle = std::clamp(below < above ? middle - width : middle + width, low + next_width, high - next_width);
      at_middle = value(middle);
    }
    const bool same_width = std::abs(next_width - width) < 0.3 * width;
    width = next_width;
    if (same_width && moved < kSettled * width) break;
  }
  AtTau made{how, width, 0.0};
  made.how.rate_1_s = middle;
  const double share = std::sqrt(2.0 * std::numbers::pi) * width * prior_density(parts, 0.0);
  made.minus_two_log = at_middle - 2.0 * std::log(std::min(share, 1.0));
  return made;
}

}  // namespace

template <int N>
AtTau at_tau(const PartedMotion<N>& motion, double tau_s, const AtTau& neighbour) {
  Smoothness how = neighbour.how;
  how.tau_s = tau_s;
  if (neighbour.rate_sd_1_s == 0.0) return {how, 0.0, motion.minus_two_log_likelihood(how)};
  return best_rate(motion, how, how.rate_1_s, neighbour.rate_sd_1_s);
}

template <int N>
std::vector<AtTau> along_tau(const PartedMotion<N>& motion, double jump_1_s2, Rate rate_of_process,
                             const std::vector<double>& others) {
  const MotionParts& parts = motion.parts();
  const double from = std::log(least_tau(parts)), to = std::log(greatest_tau(parts));
  const int count = static_cast<int>(std::ceil((to - from) / std::log(kTauRatio)));
  const auto tau = [&](int i) { return std::exp(from + i * (to - from) / count); };
  const auto value = [&](int i, double rate) {
    return motion.minus_two_log_likelihood({tau(i), rate, jump_1_s2}) -
           2.0 * std::log(prior_density(parts, rate) / prior_density(parts, 0.0));
  };
  int first = 0;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= count; ++i) {
    const double here = value(i, 0.0);
    if (here < least) {
      least = here;
      first = i;
    } else if (here > least + 10.0 * kMostDeficit) {
      break;
    }
  }
  first = std::max(first - 1, 0);
  if (rate_of_process == Rate::none) {
    std::vector<AtTau> made;
    for (int i = first; i <= count; ++i) {
      made.push_back({{tau(i), 0.0, jump_1_s2}, 0.0, value(i, 0.0)});
      if (made.back().minus_two_log > least + kMostDeficit) break;
    }
    return made;
  }
  // Rates of both signs, from negligible ones to those that decay within tau.
  AtTau last{{tau(first), 0.0, jump_1_s2}, 0.5 / parts.longest_s, least};
  least = value(first, 0.0);
  for (double rate = 0.5 / parts.longest_s; rate < std::min(0.5 / tau(first), kFastest / parts.step_s); rate *= 2.0) {
    for (const double signed_rate : {rate, -rate}) {
      if (signed_rate < -0.9 * kGrowing / parts.longest_s) continue;
      const double here = value(first, signed_rate);
      if (here >= least) continue;
      least = here;
      last.how.rate_1_s = signed_rate;
      last.rate_sd_1_s = 0.5 * rate;
    }
  }
  std::vector<AtTau> made;
  double best = std::numeric_limits<double>::infinity();
  for (int i = first; i <= count; ++i) {
    AtTau start = last;
    double at_start = value(i, start.how.rate_1_s);
    for (const double other : others) {
      const double here = value(i, other);
      if (here >= at_start) continue;
      at_start = here;
      start.how.rate_1_s = other;
    }
    last = at_tau(motion, tau(i), start);
    made.push_back(last);
    best = std::min(best, last.minus_two_log);
    if (made.size() > 2 && last.minus_two_log > best + kMostDeficit &&
        made[made.size() - 2].minus_two_log > best + kMostDeficit) {
      break;
    }
  }
  return made;
}

template <int N>
AtTau refined(const PartedMotion<N>& motion, const AtTau& near) {
  const double from = std::log(least_tau(motion.parts())), to = std::log(greatest_tau(motion.parts()));
  const double middle = std::log(near.how.tau_s), step = std::log(kTauRatio);
  AtTau best = near;
  best.minus_two_log = std::numeric_limits<double>::infinity();
  const auto at = [&](double log_tau) {
    const AtTau here = at_tau(motion, std::exp(log_tau), near);
    if (here.minus_two_log < best.minus_two_log) best = here;
    return here.minus_two_log;
  };
  at(middle);
  boost::math::tools::brent_find_minima(at, std::max(middle - step, from), std::min(middle + step, to), kBrentBits);
  return best;
}

template <int N>
AtTau with_jump(const PartedMotion<N>& motion, AtTau near) {
  const auto posteriors = motion.posteriors(near.how);
  double squares = 0.0, count = 0.0;
  for (const ChainPosterior<N>& posterior : posteriors) {
    for (std::size_t k = 1; k < posterior.size(); ++k) {
      if (!posterior.node(k).after_break) continue;
      squares += std::pow(posterior.mean(k)[2] - posterior.mean(k - 1)[2], 2);
      count += 1.0;
    }
  }
  const double noise = std::sqrt(motion.noise_variance(motion.fit(near.how)));
  const double about = std::log(std::sqrt(squares / count) / noise);
  constexpr double kBelow = 7.0, kAbove = 5.0;  // e-folds
  const auto of_jump = [&](double log_jump) {
    Smoothness how = near.how;
    how.jump_1_s2 = std::exp(log_jump);
    return motion.minus_two_log_likelihood(how);
  };
  near.how.jump_1_s2 =
      std::exp(boost::math::tools::brent_find_minima(of_jump, about - kBelow, about + kAbove, kBrentBits).first);
  return refined(motion, near);
}

template <int N>
std::vector<AtTau> spread(const PartedMotion<N>& motion, const AtTau& best) {
  constexpr double kMostSpreadDeficit = 10.0;  // of -2 log: a weight of 0.7 %
  const double from = std::log(least_tau(motion.parts())), to = std::log(greatest_tau(motion.parts()));
  const double middle = std::log(best.how.tau_s), widest = std::log(kTauRatio);
  // The standard deviation of log tau on the side where -2 log rises faster.
  double rise = 0.0;
  constexpr double kTrialStep = 0.05;  // of log tau
  for (const double off : {-kTrialStep, kTrialStep}) {
    const AtTau here = at_tau(motion, std::exp(std::clamp(middle + off, from, to)), best);
    rise = std::max(rise, here.minus_two_log - best.minus_two_log);
  }
  const double sd = rise > 0.0 ? kTrialStep / std::sqrt(rise) : widest;
  const double step = std::min(kStepOfSpread * sd, widest);
  std::vector<AtTau> made{best};
  for (const double sign : {-1.0, 1.0}) {
    AtTau last = best;
    for (int i = 1;; ++i) {
      const double log_tau = middle + sign * i * step;
      if (log_tau < from || log_tau > to) break;
      last = at_tau(motion, std::exp(log_tau), last);
      if (last.minus_two_log > best.minus_two_log + kMostSpreadDeficit) break;
      made.push_back(last);
    }
  }
  // Each represents a step of log tau.
  for (AtTau& one : made) one.minus_two_log -= 2.0 * std::log(step);
  return made;
}

template <int N>
AtTau exact(const PartedMotion<N>& motion, const AtTau& best) {
  const double from = std::log(least_tau(motion.parts())), to = std::log(greatest_tau(motion.parts()));
  AtTau last = best;
  for (double log_tau = std::log(best.how.tau_s); log_tau < to;) {
    log_tau = std::min(log_tau + std::log(kTauRatio), to);
    last = at_tau(motion, std::exp(log_tau), last);
    if (last.minus_two_log > best.minus_two_log + kMostDeficit) break;
  }
  last.minus_two_log -= 2.0 * std::log(kSpike * (to - from));
  return last;
}

template std::vector<AtTau> along_tau(const PartedMotion<3>&, double, Rate, const std::vector<double>&);
template std::vector<AtTau> along_tau(const PartedMotion<4>&, double, Rate, const std::vector<double>&);
template std::vector<AtTau> along_tau(const PartedMotion<5>&, double, Rate, const std::vector<double>&);
template AtTau at_tau(const PartedMotion<3>&, double, const AtTau&);
template AtTau at_tau(const PartedMotion<4>&, double, const AtTau&);
template AtTau at_tau(const PartedMotion<5>&, double, const AtTau&);
template AtTau refined(const PartedMotion<3>&, const AtTau&);
template AtTau refined(const PartedMotion<4>&, const AtTau&);
template AtTau refined(const PartedMotion<5>&, const AtTau&);
template AtTau with_jump(const PartedMotion<3>&, AtTau);
template AtTau with_jump(const PartedMotion<4>&, AtTau);
template AtTau with_jump(const PartedMotion<5>&, AtTau);
template AtTau exact(const PartedMotion<3>&, const AtTau&);
template AtTau exact(const PartedMotion<4>&, const AtTau&);
template AtTau exact(const PartedMotion<5>&, const AtTau&);
template std::vector<AtTau> spread(const PartedMotion<3>&, const AtTau&);
template std::vector<AtTau> spread(const PartedMotion<4>&, const AtTau&);
template std::vector<AtTau> spread(const PartedMotion<5>&, const AtTau&);

}  // namespace glidelab::core
