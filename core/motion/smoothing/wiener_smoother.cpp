#include "core/motion/smoothing/wiener_smoother.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/math/tools/minima.hpp>
#include <cassert>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "core/motion/smoothing/parted_motion.h"
#include "core/motion/smoothing/rate_response.h"
#include "core/motion/smoothing/smoothing_ensemble.h"
#include "core/motion/smoothing/smoothness_search.h"

namespace glidelab::core {
namespace {

enum class StrengthBy { likelihood, cross_validation };

constexpr double kMostRows = 300.0;        // for a motion whose kernels reach far; otherwise
constexpr double kRowsOfParameter = 10.0;  // for each effective parameter of the smoothing
constexpr int kLeastOrder = 3, kOrders = 3;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kMostOrderDeficit = 20.0;  // of -2 log: orders that are less probable by a factor e^-10 are left out
constexpr double kLeastWeight = 1e-3;       // of a member, over the likelihood of the most probable one
constexpr double kLeastShare = 0.1;         // of the heaviest member: where the steps of log tau make all of them light
constexpr double kBreakSettled = 1e-4;      // of a step
constexpr int kBreakPasses = 6, kBreakSearches = 3;
constexpr double kCostOfParameter = 1.4;  // of cross-validation (Kim and Gu 2004): a value of 1 occasionally follows
                                          // the noise

/// Calls what(order), an integral constant, for every order, or for one.
template <typename What>
void for_order(int order, What&& what) {
  if (order == 3) what(std::integral_constant<int, 3>());
  if (order == 4) what(std::integral_constant<int, 4>());
  if (order == 5) what(std::integral_constant<int, 5>());
}
template <typename What>
void for_orders(What&& what) {
  for (int order = kLeastOrder; order < kLeastOrder + kOrders; ++order) for_order(order, what);
}

struct Choice {
  int order = 0;
  AtTau at;
};

/// The most likely process of each order, with a free jump of a at a break.
std::vector<Choice> search(const MotionParts& parts, std::vector<double> rates_1_s) {
  std::vector<Choice> found;
  for_orders([&](auto order) {
    const PartedMotion<order> motion(parts);
    found.push_back({order, likeliest(along_tau(motion, kInfinity, Rate::none, {}))});
    found.push_back({order, likeliest(along_tau(motion, kInfinity, Rate::any, rates_1_s))});
    rates_1_s.push_back(found.back().at.how.rate_1_s);
  });
  return found;
}

const Choice& likeliest(const std::vector<Choice>& all) {
  return *std::min_element(all.begin(), all.end(),
                           [](const Choice& a, const Choice& b) { return a.at.minus_two_log < b.at.minus_two_log; });
}

/// The most likely process with a rate.
Choice likeliest_rate(const MotionParts& parts, std::vector<Choice> orders) {
  std::erase_if(orders, [](const Choice& one) { return one.at.rate_sd_1_s == 0.0; });
  Choice choice = likeliest(orders);
  for_order(choice.order, [&](auto order) {
    const PartedMotion<order> motion(parts);
    choice.at = parts.breaks() ? with_jump(motion, choice.at) : refined(motion, choice.at);
    // The motion without process noise, wherever that is possible: noise of a and a small k look alike.
    const AtTau without_noise = exact(motion, choice.at);
    if (without_noise.minus_two_log <= choice.at.minus_two_log + kMostOrderDeficit) choice.at = without_noise;
  });
  return choice;
}

/// Moves the breaks to where v = 0 until they stay; returns the largest displacement of the first iteration.
double settle_breaks(MotionParts& parts, const Choice& choice) {
  double first = 0.0;
  for_order(choice.order, [&](auto order) {
    for (int pass = 0; pass < kBreakPasses; ++pass) {
      const double moved = refine_breaks(PartedMotion<order>(parts).posteriors(choice.at.how), parts);
      if (pass == 0) first = moved;
      if (moved < kBreakSettled * parts.step_s) break;
    }
  });
  return first;
}

/// Over the likelihood of the most probable process.
double weight_of(const AtTau& at, double best) {
  return std::exp(-0.5 * (at.minus_two_log - best));
}

/// The processes of one order that may be members: those around the most likely tau, and last the one without noise.
struct Candidates {
  Choice choice;
  std::vector<AtTau> all;
};

/// Adds those of an order that are heavy enough, with their weights; returns the one that stands for the order with its
/// weight, which is negative where there is none.
template <int N>
std::pair<double, AtTau> add_members(const PartedMotion<N>& motion, const Candidates& candidates, double best,
                                     double least_weight, SmoothingEnsemble& ensemble) {
  const AtTau& likeliest_one = candidates.choice.at;
  const std::vector<AtTau>& all = candidates.all;
  std::pair<double, AtTau> chosen{-1.0, likeliest_one};
  double of_sum = 0.0;
  for (const AtTau& at : all) {
    const double weight = weight_of(at, best);
    if (weight < least_weight) continue;
    if (&at == &all.back()) {
      if (weight > of_sum) chosen = {weight, at};
    } else {
      of_sum += weight;
      chosen = {of_sum, likeliest_one};
    }
    // k by the three-point Gauss-Hermite rule.
    for (const auto& [off, share] :
         {std::pair{0.0, 2.0 / 3.0}, {std::sqrt(3.0), 1.0 / 6.0}, {-std::sqrt(3.0), 1.0 / 6.0}}) {
      if (at.rate_sd_1_s == 0.0 && off != 0.0) continue;
      Smoothness how = at.how;
      how.rate_1_s += off * at.rate_sd_1_s;
      const double noise_sd = std::sqrt(motion.noise_variance(motion.fit(how)));
      EnsembleMember member{at.rate_sd_1_s == 0.0 ? weight : weight * share, {}};
      for (const ChainPosterior<N>& posterior : motion.posteriors(how)) {
        member.parts.push_back(nodes_of(posterior, noise_sd));
      }
      ensemble.members.push_back(std::move(member));
    }
  }
  return chosen;
}

template <int N>
double cross_validation_of(const PartedMotion<N>& motion, const AtTau& at) {
  const SmoothedSums sums = sums_of(motion.posteriors(at.how), motion.parts());
  if (sums.points <= kCostOfParameter * sums.trace) return kInfinity;
  return sums.points * sums.squares_m2 / std::pow(sums.points - kCostOfParameter * sums.trace, 2);
}

/// The tau that minimises the criterion, with the most likely k at each tau.
template <int N>
std::pair<double, AtTau> by_cross_validation(const PartedMotion<N>& motion, Rate rate,
                                             const std::vector<double>& rates_1_s) {
  const auto criterion = [&](const AtTau& at) { return cross_validation_of(motion, at); };
  const std::vector<AtTau> along = along_tau(motion, kInfinity, rate, rates_1_s);
  std::pair<double, AtTau> best{kInfinity, along.front()};
  std::size_t of_best = 0;
  for (std::size_t i = 0; i < along.size(); ++i) {
    const double value = criterion(along[i]);
    if (value < best.first) {
      best = {value, along[i]};
      of_best = i;
    }
  }
  const double low = along[of_best > 0 ? of_best - 1 : 0].how.tau_s;
  const double high = along[std::min(of_best + 1, along.size() - 1)].how.tau_s;
  const AtTau near = best.second;
  constexpr int kBits = 8;
  boost::math::tools::brent_find_minima(
      [&](double log_tau) {
        const AtTau at = at_tau(motion, std::exp(log_tau), near);
        const double value = criterion(at);
        if (value < best.first) best = {value, at};
        return value;
      },
      std::log(low), std::log(high), kBits);
  return best;
}

/// The bandwidth of the local cubic whose a is as noisy as that of the posterior where the latter is least noisy.
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
  const std::vector<KernelRow> rows = best->rows({at});
  double squares = 0.0;
  for (const double w : rows.front().weights->a) squares += w * w;
  return std::pow(kGaussianA.variance * step_s / squares, 0.2);
}

/// The rows of every n-th point of a part.
template <int N>
void fill_rows(const ChainPosterior<N>& posterior, const SmoothedPart& part, std::size_t every,
               std::vector<std::optional<KernelRow>>& rows) {
  std::vector<std::size_t> nodes, points;
  for (std::size_t k = 0; k < posterior.size(); ++k) {
    const ChainNode& node = posterior.node(k);
    if (!node.point || *node.point % every != 0) continue;
    nodes.push_back(k);
    points.push_back(part.points.first + *node.point);
  }
  std::vector<KernelRow> of_nodes = posterior.rows(nodes);
  for (std::size_t j = 0; j < of_nodes.size(); ++j) {
    of_nodes[j].first += part.points.first;
    rows[points[j]] = std::move(of_nodes[j]);
  }
}

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
    if (input.rows) made.rows.resize(input.t_s.size());
    if (!input.along_m.empty()) {
      made.along.resize(input.t_s.size());
      made.along_at.resize(input.at_s.size());
    }
    MotionParts parts(input);
    if (parts.parts.empty() || !(parts.range_m > 0.0)) {  // what never moves has no rate, no jump and no noise
      made.strength.method = chosen_by::Nothing{};
      return made;
    }
    std::vector<Choice> orders = search(parts, {0.0});
    for (int i = 0; parts.breaks() && i < kBreakSearches; ++i) {
      const double moved = settle_breaks(parts, likeliest(orders));
      orders = search(parts, {0.0, likeliest(orders).at.how.rate_1_s});
      if (moved < kBreakSettled * parts.step_s) break;
    }
    const Choice with_rate = made.rows.empty() || !input.rate_in_rows ? Choice{} : likeliest_rate(parts, orders);
    const double least = likeliest(orders).at.minus_two_log;
    std::erase_if(orders, [&](const Choice& one) { return one.at.minus_two_log > least + kMostOrderDeficit; });
    for (Choice& choice : orders) {
      for_order(choice.order, [&](auto order) {
        const PartedMotion<order> motion(parts);
        choice.at = parts.breaks() ? with_jump(motion, choice.at) : refined(motion, choice.at);
      });
    }
    SmoothingEnsemble ensemble;
    const double best = likeliest(orders).at.minus_two_log;
    std::vector<Candidates> candidates;
    double heaviest = 0.0;
    for (const Choice& choice : orders) {
      for_order(choice.order, [&](auto order) {
        const PartedMotion<order> motion(parts);
        candidates.push_back({choice, spread(motion, choice.at)});
        candidates.back().all.push_back(exact(motion, choice.at));
      });
      for (const AtTau& at : candidates.back().all) heaviest = std::max(heaviest, weight_of(at, best));
    }
    // The more positions, the narrower log tau and its steps, and the lighter every single member. n positions tell a
    // variance to sqrt(2/n), and log tau to that over twice the order: members lighter still are no process, as beyond
    // a gap of many times the smoothing time, where the numbers break down.
    const double narrowest = kStepOfSpread * std::sqrt(2.0 / static_cast<double>(parts.input.t_s.size())) /
                             (2.0 * (kLeastOrder + kOrders - 1));
    const double least_weight = heaviest < narrowest ? kLeastWeight : std::min(kLeastWeight, kLeastShare * heaviest);
    Choice most;
    double most_weight = -1.0;
    for (const Candidates& of_order : candidates) {
      for_order(of_order.choice.order, [&](auto order) {
        const auto [weight, at] =
            add_members<order>(PartedMotion<order>(parts), of_order, best, least_weight, ensemble);
        if (weight <= most_weight) return;
        most_weight = weight;
        most = {order, at};
      });
    }
    double sum = 0.0;
    for (const EnsembleMember& member : ensemble.members) sum += member.weight;
    for (EnsembleMember& member : ensemble.members) member.weight /= sum;

    const Choice chosen = by_ == StrengthBy::likelihood ? most : cross_validated(parts, orders);
    for_order(chosen.order, [&](auto order) { finish<order>(parts, chosen, std::move(ensemble), made); });
    if (!input.rows) return made;
    const bool shows_no_rate = input.rate_in_rows && chosen.at.rate_sd_1_s == 0.0;
    const Choice of_rows = shows_no_rate ? with_rate : chosen;
    for_order(of_rows.order, [&](auto order) { add_rows<order>(parts, of_rows, shows_no_rate, made); });
    return made;
  }

 private:
  static Choice cross_validated(const MotionParts& parts, const std::vector<Choice>& orders) {
    Choice best;
    AtTau of_least_order;
    double least = kInfinity;
    for_orders([&](auto order) {
      for (const Rate rate : {Rate::none, Rate::any}) {
        const auto [value, at] =
            by_cross_validation(PartedMotion<order>(parts), rate, {0.0, likeliest(orders).at.how.rate_1_s});
        if (order == kLeastOrder) of_least_order = at;
        if (best.order != 0 && value >= least) continue;
        best = {order, at};
        least = value;
      }
    });
    // A motion under constant and viscous friction stands unless another is better by more than noise makes it.
    const PartedMotion<kLeastOrder> motion(parts);
    Choice plain{kLeastOrder, exact(motion, of_least_order)};
    plain.at.how.tau_s = std::max(plain.at.how.tau_s, 0.5 * parts.longest_s);
    const double gain = parts.points * std::log(cross_validation_of(motion, plain.at) / least);
    return gain > std::log(parts.points) ? best : plain;
  }

  template <int N>
  void finish(const MotionParts& parts, const Choice& chosen, SmoothingEnsemble ensemble, SmoothedSeries& made) const {
    const PartedMotion<N> motion(parts);
    const std::vector<ChainPosterior<N>> posteriors = motion.posteriors(chosen.at.how);
    const ChainFit fit = motion.fit(chosen.at.how);
    const SmoothedSums sums = sums_of(posteriors, parts);
    for (const ChainPosterior<N>& posterior : posteriors) {
      ensemble.nodes.emplace_back();
      ensemble.smoothed.emplace_back();
      for (std::size_t k = 0; k < posterior.size(); ++k) {
        ensemble.nodes.back().push_back(posterior.node(k));
        ensemble.smoothed.back().push_back(posterior.mean(k).template head<3>());
      }
    }
    if (!parts.input.noise_sd_m) ensemble.freedom = std::max(fit.freedom - 2.0, 1.0);
    const double variance =
        by_ == StrengthBy::likelihood || parts.input.noise_sd_m ? motion.noise_variance(fit) : sums.noise_variance();
    SmoothingStrength& strength = made.strength;
    if (by_ == StrengthBy::likelihood) {
      strength.method = chosen_by::Likelihood{};
    } else {
      strength.method = chosen_by::CrossValidation{};
    }
    strength.noise_sd_m = std::sqrt(variance);
    strength.order = N;
    strength.rate_1_s = chosen.at.how.rate_1_s;
    strength.time_s = chosen.at.how.tau_s;
    strength.parameters = sums.trace;
    strength.bandwidth_s = like_bandwidth(posteriors, parts.step_s);
    if (parts.breaks()) strength.jump_sd_m_s2 = strength.noise_sd_m * chosen.at.how.jump_1_s2;
    const auto sd = standard_deviations(ensemble, parts.input.stop_check);
    for (std::size_t p = 0; p < parts.parts.size(); ++p) {
      const SmoothedPart& part = parts.parts[p];
      strength.breaks_s.insert(strength.breaks_s.end(), part.breaks_s.begin(), part.breaks_s.end());
      fill(posteriors[p], sd[p], part, made.points, made.at);
    }
    if (!parts.input.along_m.empty()) {
      SmoothingInput other = parts.input;
      other.x_m = parts.input.along_m;
      MotionParts along(other);
      along.parts = parts.parts;  // with the breaks as found
      const std::vector<ChainPosterior<N>> of_other = PartedMotion<N>(along).posteriors(chosen.at.how);
      for (std::size_t p = 0; p < parts.parts.size(); ++p) {
        fill(of_other[p], sd[p], parts.parts[p], made.along, made.along_at);
      }
    }
    if (parts.input.simultaneous) strength.simultaneous_a = simultaneous_factor(ensemble, sd, parts.input.stop_check);
  }

  /// The rows of a process, and its points if they are not those of the smoothed motion.
  template <int N>
  void add_rows(const MotionParts& parts, const Choice& of, bool points_too, SmoothedSeries& made) const {
    const PartedMotion<N> motion(parts);
    const std::vector<ChainPosterior<N>> posteriors = motion.posteriors(of.at.how);
    const SmoothedSums sums = sums_of(posteriors, parts);
    const double most_rows = std::max(kMostRows, kRowsOfParameter * sums.trace);
    const std::size_t every = std::max<std::size_t>(1, static_cast<std::size_t>(parts.points / most_rows));
    if (points_too) made.with_rate.resize(parts.input.t_s.size());
    std::vector<std::optional<SmoothedState>> times(parts.input.at_s.size());
    for (std::size_t p = 0; p < parts.parts.size(); ++p) {
      fill_rows(posteriors[p], parts.parts[p], every, made.rows);
      if (!points_too) continue;
      const std::vector<Eigen::Array3d> unasked(posteriors[p].size(), Eigen::Array3d::Zero());
      fill(posteriors[p], unasked, parts.parts[p], made.with_rate, times);
    }
    if (!parts.input.rate_in_rows || !(of.at.rate_sd_1_s > 0.0)) return;
    made.held_rows = made.rows;
    const double variance = by_ == StrengthBy::likelihood || parts.input.noise_sd_m
                                ? motion.noise_variance(motion.fit(of.at.how))
                                : sums.noise_variance();
    const RateResponse by = rate_response(motion, of.at, variance);
    for (std::size_t p = 0; p < parts.parts.size(); ++p) {
      add_rate(posteriors[p], by.nodes[p], by.point_gain, parts.parts[p], made);
    }
  }

  template <int N>
  static void fill(const ChainPosterior<N>& posterior, const std::vector<Eigen::Array3d>& sd, const SmoothedPart& part,
                   std::vector<std::optional<SmoothedState>>& points,
                   std::vector<std::optional<SmoothedState>>& times) {
    std::size_t a = part.first_at;
    for (std::size_t k = 0; k < posterior.size(); ++k) {
      if (is_break(posterior, k)) continue;
      const ChainNode& node = posterior.node(k);
      const std::size_t of = node.point ? part.points.first + *node.point : a++;
      const auto& mean = posterior.mean(k);
      (node.point ? points : times)[of] = SmoothedState{mean[0], mean[1], mean[2], sd[k][0], sd[k][1], sd[k][2]};
    }
  }

  /// A node of a break, before or after it.
  template <int N>
  static bool is_break(const ChainPosterior<N>& posterior, std::size_t k) {
    const ChainNode& node = posterior.node(k);
    const bool before = k + 1 < posterior.size() && posterior.node(k + 1).after_break;
    return !node.point && (node.after_break || before);
  }

  template <int N>
  static void add_rate(const ChainPosterior<N>& posterior, const std::vector<Eigen::Array3d>& by_rate,
                       const std::vector<double>& point_gain, const SmoothedPart& part, SmoothedSeries& made) {
    for (std::size_t k = 0; k < posterior.size(); ++k) {
      const ChainNode& node = posterior.node(k);
      if (!node.point) continue;
      std::optional<KernelRow>& row = made.rows[part.points.first + *node.point];
      if (row) row = with_rate(*row, by_rate[k], point_gain);
    }
  }

  std::string name_, words_;
  StrengthBy by_;
};

}  // namespace

const Smoother& kalman_smoother() {
  static const WienerSmoother smoother(
      "kalman",
      "Kalman smoother of an integrated Wiener or Ornstein-Uhlenbeck process of order 3 to 5, its strength by marginal "
      "likelihood",
      StrengthBy::likelihood);
  return smoother;
}

const Smoother& spline_smoother() {
  static const WienerSmoother smoother(
      "spline", "smoothing spline of polynomials and an exponential, its strength by generalised cross-validation",
      StrengthBy::cross_validation);
  return smoother;
}

std::vector<std::optional<KernelRow>> lawless_rows(const SmoothingInput& input) {
  constexpr int kOrder = 4;
  std::vector<std::optional<KernelRow>> rows(input.t_s.size());
  MotionParts parts(input);
  if (parts.parts.empty()) return rows;
  const auto search_tau = [&]() {
    return likeliest(along_tau(PartedMotion<kOrder>(parts), kInfinity, Rate::none, {0.0}));
  };
  AtTau at = search_tau();
  for (int i = 0; parts.breaks() && i < kBreakSearches; ++i) {
    const double moved = settle_breaks(parts, {kOrder, at});
    at = search_tau();
    if (moved < kBreakSettled * parts.step_s) break;
  }
  const PartedMotion<kOrder> motion(parts);
  at = parts.breaks() ? with_jump(motion, at) : refined(motion, at);
  const std::vector<ChainPosterior<kOrder>> posteriors = motion.posteriors(at.how);
  for (std::size_t p = 0; p < parts.parts.size(); ++p) fill_rows(posteriors[p], parts.parts[p], 1, rows);
  return rows;
}

}  // namespace glidelab::core
