#include "core/math/unseen_positions.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>

#include "core/math/jump_limits.h"
#include "core/math/quantile.h"

namespace glidelab::core {
namespace {

constexpr std::size_t kFewestEqual = 4;

/// Equal neighbouring values, [from, to).
struct EqualRun {
  std::size_t from = 0, to = 0;
  double value = 0.0;
  std::size_t size() const { return to - from; }
};

std::vector<EqualRun> equal_runs(std::span<const double> x) {
  std::vector<EqualRun> runs;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (runs.empty() || runs.back().value != x[i]) runs.push_back({i, i, x[i]});
    runs.back().to = i + 1;
  }
  return runs;
}

/// The speeds of all steps, and which of them touch no value that some long run has: where it may mean that nothing is
/// seen, single ones do so as well.
class Steps {
 public:
  Steps(std::span<const double> t_s, std::span<const double> x, const std::vector<EqualRun>& runs)
      : speed_(x.size() > 0 ? x.size() - 1 : 0), counts_(speed_.size(), true) {
    for (std::size_t i = 0; i < speed_.size(); ++i) speed_[i] = std::abs(x[i + 1] - x[i]) / (t_s[i + 1] - t_s[i]);
    std::set<double> of_long_runs;
    for (const EqualRun& run : runs) {
      if (run.size() >= kFewestEqual) of_long_runs.insert(run.value);
    }
    for (const EqualRun& run : runs) {
      if (!of_long_runs.contains(run.value)) continue;
      const std::size_t from = run.from > 0 ? run.from - 1 : 0, to = std::min(run.to, speed_.size());
      std::fill(counts_.begin() + static_cast<std::ptrdiff_t>(from), counts_.begin() + static_cast<std::ptrdiff_t>(to),
                false);
    }
    std::vector<double> own;
    for (std::size_t i = 0; i < speed_.size(); ++i) {
      if (counts_[i]) own.push_back(speed_[i]);
    }
    enough_ = own.size() >= kFewestSteps;
    typical_ = quantile(own, kTypicalOfSteps);
  }

  bool enough() const { return enough_; }

  /// Whether step `i` is a jump, where the motion is on this side of it (-1 before, 1 after).
  bool is_jump(std::size_t i, int side) const {
    std::vector<double> near;
    for (std::size_t k = i; near.size() < kNearestOfJump;) {
      if (side < 0 ? k == 0 : k + 1 == speed_.size()) break;
      k = side < 0 ? k - 1 : k + 1;
      if (counts_[k]) near.push_back(speed_[k]);
    }
    return speed_[i] > kJump * std::max(typical_, quantile(near, 0.5));
  }

 private:
  std::vector<double> speed_;
  std::vector<bool> counts_;
  bool enough_ = false;
  double typical_ = 0.0;
};

bool has_only_jumps(const EqualRun& run, const Steps& steps, std::size_t positions) {
  const bool first = run.from == 0, last = run.to == positions;
  if (first && last) return false;
  return (first || steps.is_jump(run.from - 1, -1)) && (last || steps.is_jump(run.to - 1, 1));
}

}  // namespace

std::optional<UnseenPositions> unseen_positions(std::span<const double> t_s, std::span<const double> x) {
  const std::vector<EqualRun> runs = equal_runs(x);
  if (std::ranges::none_of(runs, [](const EqualRun& run) { return run.size() >= kFewestEqual; })) return {};
  const Steps steps(t_s, x, runs);
  if (!steps.enough()) return {};
  std::set<double> values;
  for (const EqualRun& run : runs) {
    if (run.size() >= kFewestEqual && has_only_jumps(run, steps, x.size())) values.insert(run.value);
  }
  if (values.empty()) return {};
  UnseenPositions unseen;
  unseen.is_unseen.resize(x.size(), false);
  for (const EqualRun& run : runs) {
    if (!values.contains(run.value)) continue;
    if (run.size() < kFewestEqual && !has_only_jumps(run, steps, x.size())) continue;
    if (unseen.count == 0) {
      unseen.value = run.value;
      unseen.from_s = t_s[run.from];
    }
    unseen.count += run.size();
    std::fill(unseen.is_unseen.begin() + static_cast<std::ptrdiff_t>(run.from),
              unseen.is_unseen.begin() + static_cast<std::ptrdiff_t>(run.to), true);
  }
  return unseen;
}

std::vector<double> without_flagged(const std::vector<double>& values, const std::vector<bool>& flagged) {
  std::vector<double> kept;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!flagged[i]) kept.push_back(values[i]);
  }
  return kept;
}

}  // namespace glidelab::core
