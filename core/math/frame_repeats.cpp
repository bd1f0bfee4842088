#include "core/math/frame_repeats.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/math/held_values.h"
#include "core/math/quantile.h"

namespace glidelab::core {
namespace {

constexpr std::size_t kBeside = 6, kMostRun = 8;  // frames
constexpr double kRepeat = 0.2, kWhole = 0.5;     // of the mean step around: at most, at least
constexpr double kUsual = 1.5;                    // of the median of whole steps: longer ones follow a loss
constexpr double kLeastStepOverNoise = 8.0;       // of the mean step, over a position's standard deviation
constexpr double kLeastOverRounding = 2.0;        // of the mean step, over the step of rounded positions
constexpr std::size_t kFewestRepeats = 3;
constexpr std::ptrdiff_t kFewestOfCadence = 4;
constexpr double kMostDoubtful = 0.1;  // steps between, over the repeats
constexpr double kMostOfKind = 0.8;    // of the repeats, for all to be of a kind
constexpr double kFast = 0.5;          // of the largest mean step: there the noise is determined

enum class StepKind { untold, repeat, whole, between };

struct FrameSteps {
  std::vector<double> size, mean;  ///< to each point from the one before, along the motion; the mean step around
  std::vector<StepKind> kind;
};

FrameSteps frame_steps(std::span<const std::size_t> frame, std::span<const double> x) {
  const std::size_t n = x.size();
  FrameSteps steps{std::vector<double>(n, 0.0), std::vector<double>(n, 0.0),
                   std::vector<StepKind>(n, StepKind::untold)};
  for (std::size_t i = 1; i < n; ++i) {
    const std::size_t a = i - 1 - std::min(i - 1, kBeside), b = std::min(n - 1, i + kBeside);
    const double mean = (x[b] - x[a]) / static_cast<double>(frame[b] - frame[a]);
    const double sign = mean < 0.0 ? -1.0 : 1.0;
    steps.size[i] = sign * (x[i] - x[i - 1]);
    steps.mean[i] = std::abs(mean);
    if (frame[i] - frame[i - 1] != 1) continue;
    const bool turns = [&] {
      for (std::size_t k = a + 1; k <= b; ++k) {
        if (sign * (x[k] - x[k - 1]) < -kRepeat * std::abs(mean)) return true;
      }
      return false;
    }();
    if (turns || mean == 0.0) continue;
    const double of_mean = steps.size[i] / steps.mean[i];
    steps.kind[i] = of_mean < kRepeat ? StepKind::repeat : of_mean < kWhole ? StepKind::between : StepKind::whole;
  }
  return steps;
}

/// A body that starts or stops makes short steps too, but not between whole ones.
void require_whole_steps_around(FrameSteps& steps) {
  const std::vector<StepKind> kind = steps.kind;
  const auto goes_on = [&](std::size_t i, bool forwards) {
    for (std::size_t k = 1; k <= kMostRun; ++k) {
      if (forwards ? i + k >= kind.size() : k > i) return false;
      const StepKind next = kind[forwards ? i + k : i - k];
      if (next != StepKind::repeat) return next == StepKind::whole;
    }
    return false;
  };
  for (std::size_t i = 0; i < kind.size(); ++i) {
    if (kind[i] == StepKind::repeat && !(goes_on(i, false) && goes_on(i, true))) steps.kind[i] = StepKind::untold;
  }
}

/// The standard deviation of a position, from whole steps that follow each other, repeats or not between them, where
/// the body is fast.
double noise_of_steps(const FrameSteps& steps) {
  constexpr double kPart = 0.8, kNormalAtPart = 1.2816;  // of the magnitudes of normal numbers
  const double top = *std::ranges::max_element(steps.mean);
  std::vector<double> changes;
  std::optional<std::size_t> before;
  for (std::size_t i = 0; i < steps.kind.size(); ++i) {
    if (steps.kind[i] == StepKind::repeat) continue;
    const bool usable = steps.kind[i] == StepKind::whole && steps.mean[i] > kFast * top;
    if (!usable) {
      before.reset();
      continue;
    }
    // A step after a loss is longer than the one before it by its whole length.
    if (before && steps.size[i] < kUsual * steps.size[*before] && steps.size[*before] < kUsual * steps.size[i])
      changes.push_back(std::abs(steps.size[i] - steps.size[*before]));
    before = i;
  }
  return quantile(std::move(changes), kPart) / (kNormalAtPart * std::sqrt(6.0));
}

/// The usual whole step around point i.
double usual_whole_step(const FrameSteps& steps, std::size_t i) {
  std::vector<double> whole;
  const std::size_t from = i - std::min(i, 2 * kBeside), to = std::min(steps.kind.size() - 1, i + 2 * kBeside);
  for (std::size_t k = from; k <= to; ++k) {
    if (steps.kind[k] == StepKind::whole) whole.push_back(steps.size[k]);
  }
  return quantile(std::move(whole), 0.5);
}

/// How many of the repeats are followed by a step that makes up for them, and by one that does not.
std::pair<std::size_t, std::size_t> made_up_for(const FrameSteps& steps) {
  std::size_t made_up = 0, not_made_up = 0, run = 0;
  for (std::size_t i = 0; i < steps.kind.size(); ++i) {
    if (steps.kind[i] == StepKind::repeat) {
      ++run;
      continue;
    }
    if (run > 0 && steps.kind[i] == StepKind::whole) {
      const double made = steps.size[i] / usual_whole_step(steps, i) - 1.0;
      (made > 0.5 * static_cast<double>(run) ? made_up : not_made_up) += run;
    }
    run = 0;
  }
  return {made_up, not_made_up};
}

double part_of_turn(double turns) {
  return turns - std::floor(turns);
}

/// Frames in a row of which each was told, and the camera's frame that each shows, from the first one's.
struct ToldRun {
  std::vector<double> frame, source;
};

/// floor(q f + phi) is the camera's frame for every f of some runs: source - q f <= phi < source + 1 - q f. The room
/// that this leaves phi is concave in q.
class Cadences {
 public:
  /// A run whose first frame shows the camera's frame `offset`.
  void add(const ToldRun& run, double offset) {
    for (std::size_t k = 0; k < run.frame.size(); ++k) {
      frame_.push_back(run.frame[k]);
      source_.push_back(run.source[k] + offset);
    }
  }

  struct Phases {
    double low = 0.0, high = 0.0;
    double room() const { return high - low; }
    double middle() const { return 0.5 * (low + high); }
  };
  Phases phases(double q) const {
    Phases phases{-HUGE_VAL, HUGE_VAL};
    for (std::size_t k = 0; k < frame_.size(); ++k) {
      const double least = source_[k] - q * frame_[k];
      phases.low = std::max(phases.low, least);
      phases.high = std::min(phases.high, least + 1.0);
    }
    return phases;
  }

  /// The ratio that leaves the phase the most room.
  double roomiest() const {
    double low = 0.0, high = 1.0;
    for (int i = 0; i < kRounds; ++i) {
      const double third = (high - low) / 3.0;
      if (phases(low + third).room() < phases(high - third).room()) {
        low += third;
      } else {
        high -= third;
      }
    }
    return 0.5 * (low + high);
  }

  /// The ratio farthest from `inside` towards `outside` that leaves any room.
  double edge(double inside, double outside) const {
    for (int i = 0; i < kRounds; ++i) {
      const double middle = 0.5 * (inside + outside);
      (phases(middle).room() > 0.0 ? inside : outside) = middle;
    }
    return inside;
  }

 private:
  static constexpr int kRounds = 80;  // to the last bit
  std::vector<double> frame_, source_;
};

/// With the frame before it, which has an image too.
std::vector<ToldRun> runs_of(std::span<const std::size_t> frame, const std::vector<StepKind>& kind) {
  std::vector<ToldRun> runs;
  for (std::size_t i = 1; i < kind.size(); ++i) {
    if (kind[i] != StepKind::repeat && kind[i] != StepKind::whole) continue;
    const auto at = static_cast<double>(frame[i]);
    if (runs.empty() || runs.back().frame.back() != at - 1.0) runs.push_back({{at - 1.0}, {0.0}});
    runs.back().source.push_back(runs.back().source.back() + (kind[i] == StepKind::whole ? 1.0 : 0.0));
    runs.back().frame.push_back(at);
  }
  std::ranges::sort(runs, {}, [](const ToldRun& run) { return -std::ssize(run.frame); });
  return runs;
}

/// The fraction of the smallest denominator in an interval (0 < low < high < 1), by the tree of Stern and Brocot.
double simplest_between(double low, double high) {
  double p0 = 0.0, q0 = 1.0, p1 = 1.0, q1 = 1.0;
  for (;;) {
    const double p = p0 + p1, q = q0 + q1;
    if (p < low * q) {
      p0 = p;
      q0 = q;
    } else if (p > high * q) {
      p1 = p;
      q1 = q;
    } else {
      return p / q;
    }
  }
}

/// From the longest run to the shortest: how far the camera counted between two runs is what leaves the most room.
std::optional<FrameCadence> cadence_of(std::span<const std::size_t> frame, const std::vector<StepKind>& kind) {
  if (std::ranges::count(kind, StepKind::repeat) < kFewestOfCadence) return std::nullopt;
  Cadences cadences;
  std::optional<double> q;
  for (const ToldRun& run : runs_of(frame, kind)) {
    const double first = q ? std::floor(*q * run.frame.front() + cadences.phases(*q).middle()) : 0.0;
    Cadences best;
    double most = 0.0;
    for (const double offset : q ? std::vector{first - 1.0, first, first + 1.0} : std::vector{0.0}) {
      Cadences with = cadences;
      with.add(run, offset);
      const double ratio = with.roomiest(), room = with.phases(ratio).room();
      if (!(room > most)) continue;
      most = room;
      q = ratio;
      best = std::move(with);
    }
    if (!(most > 0.0)) return std::nullopt;
    cadences = std::move(best);
  }
  const double ratio = simplest_between(cadences.edge(*q, 0.0), cadences.edge(*q, 1.0));
  return FrameCadence{ratio, cadences.phases(ratio).middle()};
}

}  // namespace

double FrameCadence::early_frames(std::size_t frame) const {
  const double since = part_of_turn(rate_ratio * static_cast<double>(frame) + phase) / rate_ratio;
  const double between = 1.0 / (rate_ratio * (std::ceil(1.0 / rate_ratio) + 1.0));
  return since - std::floor(since) * between;
}

bool FrameCadence::is_repeat(std::size_t frame) const {
  return part_of_turn(rate_ratio * static_cast<double>(frame) + phase) >= rate_ratio;
}

std::optional<FrameRepeats> frame_repeats(std::span<const std::size_t> frame, std::span<const double> x,
                                          double least_step) {
  if (x.size() < 2 * kBeside) return std::nullopt;
  FrameSteps steps = frame_steps(frame, x);
  require_whole_steps_around(steps);
  const double least =
      std::max({least_step, kLeastStepOverNoise * noise_of_steps(steps), kLeastOverRounding * common_step(steps.size)});
  std::size_t between = 0;
  FrameRepeats found;
  for (std::size_t i = 0; i < x.size(); ++i) {
    StepKind& kind = steps.kind[i];
    if (!(steps.mean[i] > least)) kind = StepKind::untold;
    between += kind == StepKind::between ? 1 : 0;
    if (kind == StepKind::repeat) found.points.push_back(i);
  }
  const auto many = static_cast<double>(found.points.size());
  if (found.points.size() < kFewestRepeats || static_cast<double>(between) > kMostDoubtful * many) return std::nullopt;
  const auto [made_up, not_made_up] = made_up_for(steps);
  found.in_place_of_lost = static_cast<double>(made_up) >= kMostOfKind * many;
  if (static_cast<double>(not_made_up) < kMostOfKind * many) return found;
  found.cadence = cadence_of(frame, steps.kind);
  if (!found.cadence) return found;
  found.points.clear();
  for (std::size_t i = 1; i < x.size(); ++i) {
    if (frame[i] - frame[i - 1] == 1 && found.cadence->is_repeat(frame[i])) found.points.push_back(i);
  }
  return found;
}

}  // namespace glidelab::core
