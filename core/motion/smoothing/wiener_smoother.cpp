#include "core/motion/smoothing/wiener_smoother.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "core/math/quantile.h"
#include "core/motion/smoothing/wiener_chain.h"

namespace glidelab::core {
namespace {

enum class StrengthBy { likelihood, cross_validation };

/// Of the process. Lower orders are too rough for motions under a smooth law, and smooth too little; of higher ones a
/// short clip has too few effective parameters to find their strength from.
constexpr int kOrder = 4;
constexpr double kGridRatio = 1.5;
constexpr double kLeastTau = 0.3;     // mean steps: interpolation
constexpr double kGreatestTau = 3.0;  // of the longest part: next to a parabola
constexpr int kBrentBits = 10;
constexpr double kBreakSettled = 1e-3;  // of a step
constexpr int kBreakPasses = 4;
constexpr double kSpreadRatio = 1.3;  // from one strength that is averaged over to the next
constexpr int kSpread = 4;            // of them to each side
constexpr int kDraws = 2000;          // of a whole a(t): the band's 95 % is good to 0.5 %
constexpr std::uint64_t kDrawsFrom = 0x5eed;

/// One part with its own breaks.
struct Part {
  SeriesPart points;
  std::vector<double> breaks_s;
  std::vector<double> at_s;
  std::size_t first_at = 0;  // of at_s in the input's
};

template <int N>
class PartedMotion {
 public:
  explicit PartedMotion(const SmoothingInput& input) : input_(input) {
    std::size_t a = 0, b = 0;
    double span = 0.0, steps = 0.0;
    for (const SeriesPart& points : parts_of(input)) {
      const double from = input.t_s[points.first], to = input.t_s[points.first + points.count - 1];
      Part part{points, {}, {}, 0};
      while (a < input.at_s.size() && input.at_s[a] < from) ++a;
      part.first_at = a;
      for (; a < input.at_s.size() && input.at_s[a] <= to; ++a) part.at_s.push_back(input.at_s[a]);
      while (b < input.breaks_s.size() && input.breaks_s[b] <= from) ++b;
      for (; b < input.breaks_s.size() && input.breaks_s[b] < to; ++b) part.breaks_s.push_back(input.breaks_s[b]);
      if (points.count < kFewestSmoothed) continue;
      while (!breaks_stand(part)) part.breaks_s.pop_back();
      span += to - from;
      steps += static_cast<double>(points.count - 1);
      longest_s_ = std::max(longest_s_, to - from);
      parts_.push_back(std::move(part));
    }
    step_s_ = steps > 0.0 ? span / steps : 0.0;
    const auto [low, high] = std::minmax_element(input.x_m.begin(), input.x_m.end());
    // What doubles cannot tell apart is no noise.
    const double rounding = parts_.empty() ? 0.0 : std::numeric_limits<double>::epsilon() * (*high - *low);
    least_variance_ = std::max(rounding * rounding, std::numeric_limits<double>::min());
    chain();
  }

  bool empty() const { return parts_.empty(); }
  const std::vector<Part>& parts() const { return parts_; }
  double step_s() const { return step_s_; }
  double longest_s() const { return longest_s_; }
  bool breaks() const {
    return std::any_of(parts_.begin(), parts_.end(), [](const Part& part) { return !part.breaks_s.empty(); });
  }

  WienerRatio ratio(double tau_s, double jump_1_s2) const {
    return {step_s_ / std::pow(tau_s, 2 * N), jump_1_s2, tau_s};
  }

  double noise_variance(const ChainFit& fit) const {
    if (input_.noise_sd_m) return std::max(std::pow(*input_.noise_sd_m, 2), least_variance_);
    return std::max(fit.noise_variance(), least_variance_);
  }
  ChainFit fit(const WienerRatio& ratio) const {
    ChainFit all;
    for (const WienerChain<N>& chain : chains_) all += chain.fit(ratio);
    return all;
  }
  /// -2 log of the marginal likelihood and of the prior of the strength, which is flat in sqrt(q) and so goes as
  /// tau^-N: where motions are so smooth that tau has no upper end, its likelihood alone has none either.
  double minus_two_log_posterior(const WienerRatio& ratio) const {
    const ChainFit all = fit(ratio);
    return all.minus_two_log_likelihood(noise_variance(all)) - std::log(ratio.density);
  }

  std::vector<ChainPosterior<N>> posteriors(const WienerRatio& ratio) const {
    std::vector<ChainPosterior<N>> all;
    for (const WienerChain<N>& chain : chains_) all.push_back(chain.posterior(ratio));
    return all;
  }

  /// Moves each break to the next time at which the smoothed v is 0; the farthest that one moved.
  double refine_breaks(const std::vector<ChainPosterior<N>>& posteriors) {
    double farthest = 0.0;
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      for (std::size_t b = 0; b < parts_[p].breaks_s.size(); ++b) {
        const std::optional<double> turn = turn_near(posteriors[p], parts_[p].breaks_s[b]);
        if (!turn) continue;
        const double before = std::exchange(parts_[p].breaks_s[b], *turn);
        if (breaks_stand(parts_[p])) {
          farthest = std::max(farthest, std::abs(*turn - before));
        } else {
          parts_[p].breaks_s[b] = before;
        }
      }
    }
    chain();
    return farthest;
  }

 private:
  bool breaks_stand(const Part& part) const {
    const auto begin = input_.t_s.begin() + static_cast<std::ptrdiff_t>(part.points.first);
    const auto end = begin + static_cast<std::ptrdiff_t>(part.points.count);
    auto from = begin;
    for (const double t : part.breaks_s) {
      const auto to = std::lower_bound(from, end, t);
      if (to - from < static_cast<std::ptrdiff_t>(kFewestSmoothed)) return false;
      from = to;
    }
    return part.breaks_s.empty() || end - from >= static_cast<std::ptrdiff_t>(kFewestSmoothed);
  }

  static std::optional<double> turn_near(const ChainPosterior<N>& posterior, double near_s) {
    std::optional<double> nearest;
    for (std::size_t k = 1; k < posterior.size(); ++k) {
      const double before = posterior.mean(k - 1)[1], after = posterior.mean(k)[1];
      if (before * after > 0.0 || before == after) continue;
      const double from = posterior.node(k - 1).t_s, to = posterior.node(k).t_s;
      const double at = from + (to - from) * before / (before - after);
      if (!nearest || std::abs(at - near_s) < std::abs(*nearest - near_s)) nearest = at;
    }
    return nearest;
  }

  void chain() {
    chains_.clear();
    for (const Part& part : parts_) {
      const std::span factor = input_.noise_factor.empty()
                                   ? std::span<const double>()
                                   : std::span(input_.noise_factor).subspan(part.points.first, part.points.count);
      chains_.emplace_back(ChainData{std::span(input_.t_s).subspan(part.points.first, part.points.count),
                                     std::span(input_.x_m).subspan(part.points.first, part.points.count), factor,
                                     part.breaks_s, part.at_s});
    }
  }

  const SmoothingInput& input_;
  std::vector<Part> parts_;
  std::vector<WienerChain<N>> chains_;
  double step_s_ = 0.0, longest_s_ = 0.0, least_variance_ = 0.0;
};

struct Choice {
  double tau_s = 0.0;
  double jump_1_s2 = std::numeric_limits<double>::infinity();
  double noise_variance = 0.0;
  bool smoothest = false, roughest = false;
};

struct CrossValidation {
  double squares = 0.0, points = 0.0, trace = 0.0;
  double criterion() const { return points * squares / std::pow(points - trace, 2); }
  double noise_variance() const { return squares / (points - trace); }
};

template <int N>
CrossValidation cross_validation(const PartedMotion<N>& motion, const std::vector<ChainPosterior<N>>& posteriors) {
  CrossValidation sums;
  for (std::size_t p = 0; p < posteriors.size(); ++p) {
    sums.squares += posteriors[p].residual_squares_m2();
    sums.trace += posteriors[p].trace();
    sums.points += static_cast<double>(motion.parts()[p].points.count);
  }
  return sums;
}

/// Sets tau to that of the least criterion(tau), of all or near the one that is chosen.
enum class Tau { any, near };
template <int N, typename Criterion>
void choose_tau(const PartedMotion<N>& motion, const Criterion& criterion, Tau where, Choice& choice) {
  const double from = std::log(kLeastTau * motion.step_s()), to = std::log(kGreatestTau * motion.longest_s());
  const auto count = static_cast<int>(std::ceil((to - from) / std::log(kGridRatio)));
  const double step = (to - from) / count;
  const auto at = [&](double log_tau) { return criterion(std::exp(log_tau)); };
  if (where == Tau::near) {
    const double middle = std::log(choice.tau_s);
    choice.tau_s = std::exp(boost::math::tools::brent_find_minima(at, std::max(middle - step, from),
                                                                  std::min(middle + step, to), kBrentBits)
                                .first);
    return;
  }
  int best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= count; ++i) {
    const double value = at(from + i * step);
    if (value < least) {
      least = value;
      best = i;
    }
  }
  choice.smoothest = best == count;
  choice.roughest = best == 0;
  const double low = from + std::max(best - 1, 0) * step, high = from + std::min(best + 1, count) * step;
  choice.tau_s = std::exp(boost::math::tools::brent_find_minima(at, low, high, kBrentBits).first);
}

/// The root mean square of the jumps that the positions show where any is allowed.
template <int N>
double free_jumps_m_s2(const std::vector<ChainPosterior<N>>& posteriors) {
  double squares = 0.0, count = 0.0;
  for (const ChainPosterior<N>& posterior : posteriors) {
    for (std::size_t k = 1; k < posterior.size(); ++k) {
      if (!posterior.node(k).after_break) continue;
      squares += std::pow(posterior.mean(k)[2] - posterior.mean(k - 1)[2], 2);
      count += 1.0;
    }
  }
  return std::sqrt(squares / count);
}

template <int N>
Choice choose(PartedMotion<N>& motion, StrengthBy by) {
  Choice choice;
  const auto criterion = [&](double tau_s) {
    const WienerRatio ratio = motion.ratio(tau_s, choice.jump_1_s2);
    return by == StrengthBy::likelihood ? motion.minus_two_log_posterior(ratio)
                                        : cross_validation(motion, motion.posteriors(ratio)).criterion();
  };
  choose_tau(motion, criterion, Tau::any, choice);
  if (motion.breaks()) {
    for (int pass = 0; pass < kBreakPasses; ++pass) {
      const auto posteriors = motion.posteriors(motion.ratio(choice.tau_s, choice.jump_1_s2));
      if (motion.refine_breaks(posteriors) < kBreakSettled * motion.step_s()) break;
    }
    choose_tau(motion, criterion, Tau::near, choice);
    if (by == StrengthBy::likelihood) {
      const WienerRatio free = motion.ratio(choice.tau_s, choice.jump_1_s2);
      const double noise = std::sqrt(motion.noise_variance(motion.fit(free)));
      const double about = std::log(free_jumps_m_s2(motion.posteriors(free)) / noise);
      constexpr double kBelow = 7.0, kAbove = 5.0;  // e-folds
      const auto of_jump = [&](double log_jump) {
        return motion.minus_two_log_posterior(motion.ratio(choice.tau_s, std::exp(log_jump)));
      };
      choice.jump_1_s2 =
          std::exp(boost::math::tools::brent_find_minima(of_jump, about - kBelow, about + kAbove, kBrentBits).first);
      choose_tau(motion, criterion, Tau::near, choice);
    }
  }
  return choice;
}

/// What the positions say of the strength itself: posteriors about the chosen one with the weights of their
/// likelihoods. The covariance about the chosen mean is that within them and between them.
template <int N>
struct Spread {
  struct Member {
    std::vector<ChainPosterior<N>> posteriors;
    double weight = 0.0;
    double noise_sd = 0.0;
  };
  std::vector<Member> members;  // the chosen one first

  const std::vector<ChainPosterior<N>>& chosen() const { return members.front().posteriors; }

  /// Variances of x, v and a at a node.
  Eigen::Array3d variance(std::size_t p, std::size_t k) const {
    Eigen::Array3d sum = Eigen::Array3d::Zero();
    const Eigen::Array3d middle = chosen()[p].mean(k).template head<3>().array();
    for (const Member& member : members) {
      const ChainPosterior<N>& of = member.posteriors[p];
      const Eigen::Array3d within = of.covariance(k).diagonal().template head<3>().array();
      const Eigen::Array3d off = of.mean(k).template head<3>().array() - middle;
      sum += member.weight * (member.noise_sd * member.noise_sd * within + off * off);
    }
    return sum;
  }
};

template <int N>
Spread<N> spread_of(const PartedMotion<N>& motion, const Choice& choice, StrengthBy by, double noise_variance) {
  Spread<N> spread;
  spread.members.push_back(
      {motion.posteriors(motion.ratio(choice.tau_s, choice.jump_1_s2)), 1.0, std::sqrt(noise_variance)});
  if (by == StrengthBy::cross_validation) return spread;
  const double best = motion.minus_two_log_posterior(motion.ratio(choice.tau_s, choice.jump_1_s2));
  double sum = 1.0;
  for (int i = -kSpread; i <= kSpread; ++i) {
    const WienerRatio ratio = motion.ratio(choice.tau_s * std::pow(kSpreadRatio, i), choice.jump_1_s2);
    const ChainFit fit = motion.fit(ratio);
    const double variance = motion.noise_variance(fit);
    const double weight = std::exp(-0.5 * (motion.minus_two_log_posterior(ratio) - best));
    constexpr double kNoMatter = 1e-3;
    if (i == 0 || !(weight > kNoMatter)) continue;
    spread.members.push_back({motion.posteriors(ratio), weight, std::sqrt(variance)});
    sum += weight;
  }
  for (auto& member : spread.members) member.weight /= sum;
  return spread;
}

/// The quantile of max |a - E a| / sd a over all nodes, by draws of the posterior.
template <int N>
double simultaneous_factor(const Spread<N>& spread) {
  boost::random::mt19937_64 random(kDrawsFrom);
  boost::random::normal_distribution<double> normal;
  const auto draw = [&] { return normal(random); };
  std::vector<std::vector<double>> per_sd;
  for (std::size_t p = 0; p < spread.chosen().size(); ++p) {
    per_sd.emplace_back();
    for (std::size_t k = 0; k < spread.chosen()[p].size(); ++k) {
      per_sd.back().push_back(1.0 / std::sqrt(spread.variance(p, k)[2]));
    }
  }
  std::vector<double> greatest;
  double share = 0.0;
  for (const auto& member : spread.members) {
    share += member.weight;
    while (static_cast<double>(greatest.size()) < share * kDraws - 0.5) {
      double most = 0.0;
      for (std::size_t p = 0; p < member.posteriors.size(); ++p) {
        const ChainPosterior<N>& of = member.posteriors[p];
        const auto off = of.draw(draw);
        for (std::size_t k = 0; k < off.size(); ++k) {
          const double a = member.noise_sd * off[k][2] + of.mean(k)[2] - spread.chosen()[p].mean(k)[2];
          most = std::max(most, std::abs(a) * per_sd[p][k]);
        }
      }
      greatest.push_back(most);
    }
  }
  return quantile(std::move(greatest), 0.95);
}

template <int N>
SmoothedState state_of(const Spread<N>& spread, std::size_t p, std::size_t k) {
  const Eigen::Vector3d mean = spread.chosen()[p].mean(k).template head<3>();
  const Eigen::Array3d sd = spread.variance(p, k).sqrt();
  return {mean[0], mean[1], mean[2], sd[0], sd[1], sd[2]};
}

/// The bandwidth of the local cubic whose a has as much noise as the posterior's where that has least.
template <int N>
double like_bandwidth(const std::vector<ChainPosterior<N>>& posteriors, double step_s) {
  const ChainPosterior<N>* best = nullptr;
  std::size_t at = 0;
  for (const ChainPosterior<N>& posterior : posteriors) {
    for (std::size_t k = 0; k < posterior.size(); ++k) {
      if (best != nullptr && posterior.covariance(k)(2, 2) >= best->covariance(at)(2, 2)) continue;
      best = &posterior;
      at = k;
    }
  }
  double squares = 0.0;
  for (const double w : best->rows({at}).front().weights->a) squares += w * w;
  return std::pow(kGaussianA.variance * step_s / squares, 0.2);
}

std::string words_of(StrengthBy by, const Choice& choice) {
  std::string words =
      by == StrengthBy::likelihood ? "maximum marginal likelihood" : "minimum generalised cross-validation";
  if (choice.smoothest) words += " (the smoothest tried)";
  if (choice.roughest) words += " (the roughest tried)";
  return words;
}

template <int N>
class WienerSmoother final : public Smoother {
 public:
  WienerSmoother(std::string_view name, std::string_view words, StrengthBy by) : name_(name), words_(words), by_(by) {}
  std::string_view name() const override { return name_; }
  std::string_view words() const override { return words_; }
  bool takes_bandwidth() const override { return false; }

  SmoothedSeries smooth(const SmoothingInput& input) const override {
    assert(!input.bandwidth_s && input.t_s.size() == input.x_m.size());
    SmoothedSeries made;
    made.strength.smoother = name_;
    made.points.resize(input.t_s.size());
    made.at.resize(input.at_s.size());
    if (input.rows) {
      made.rows.resize(input.t_s.size());
      made.rows_at.resize(input.at_s.size());
    }
    PartedMotion<N> motion(input);
    if (motion.empty()) {
      made.strength.method = "no part of the motion is long enough to be smoothed";
      return made;
    }
    const Choice choice = choose(motion, by_);
    const WienerRatio ratio = motion.ratio(choice.tau_s, choice.jump_1_s2);
    const CrossValidation sums = cross_validation(motion, motion.posteriors(ratio));
    const double variance = by_ == StrengthBy::likelihood || input.noise_sd_m ? motion.noise_variance(motion.fit(ratio))
                                                                              : sums.noise_variance();
    const Spread<N> spread = spread_of(motion, choice, by_, variance);
    made.strength.method = words_of(by_, choice);
    made.strength.noise_sd_m = std::sqrt(variance);
    made.strength.time_s = choice.tau_s;
    made.strength.parameters = sums.trace;
    made.strength.bandwidth_s = like_bandwidth(spread.chosen(), motion.step_s());
    if (motion.breaks()) made.strength.jump_sd_m_s2 = made.strength.noise_sd_m * choice.jump_1_s2;
    for (std::size_t p = 0; p < motion.parts().size(); ++p) {
      const Part& part = motion.parts()[p];
      made.strength.breaks_s.insert(made.strength.breaks_s.end(), part.breaks_s.begin(), part.breaks_s.end());
      fill(spread, p, part, input, made);
    }
    if (input.simultaneous) made.strength.simultaneous_a = simultaneous_factor(spread);
    return made;
  }

 private:
  static void fill(const Spread<N>& spread, std::size_t p, const Part& part, const SmoothingInput& input,
                   SmoothedSeries& made) {
    const ChainPosterior<N>& posterior = spread.chosen()[p];
    std::vector<std::size_t> nodes;               // of points and of wanted times
    std::vector<std::optional<KernelRow>*> rows;  // where theirs go
    std::size_t a = part.first_at;
    for (std::size_t k = 0; k < posterior.size(); ++k) {
      const ChainNode& node = posterior.node(k);
      const bool before_break = k + 1 < posterior.size() && posterior.node(k + 1).after_break;
      if (!node.point && (node.after_break || before_break)) continue;
      const std::size_t of = node.point ? part.points.first + *node.point : a++;
      (node.point ? made.points : made.at)[of] = state_of(spread, p, k);
      if (!input.rows) continue;
      nodes.push_back(k);
      rows.push_back(&(node.point ? made.rows : made.rows_at)[of]);
    }
    std::vector<KernelRow> of_nodes = posterior.rows(nodes);
    for (std::size_t j = 0; j < of_nodes.size(); ++j) {
      of_nodes[j].first += part.points.first;
      *rows[j] = std::move(of_nodes[j]);
    }
  }

  std::string name_, words_;
  StrengthBy by_;
};

}  // namespace

const Smoother& kalman_smoother() {
  static const WienerSmoother<kOrder> smoother(
      "kalman",
      "Kalman smoother of the integrated Wiener process of order 4, its strength by "
      "marginal likelihood",
      StrengthBy::likelihood);
  return smoother;
}

const Smoother& spline_smoother() {
  static const WienerSmoother<kOrder> smoother(
      "spline", "smoothing spline of degree 7, its strength by generalised cross-validation",
      StrengthBy::cross_validation);
  return smoother;
}

}  // namespace glidelab::core
