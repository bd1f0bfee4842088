#include "core/check/finding.h"

#include <fmt/format.h>

#include <cmath>

#include "core/result/estimate.h"

namespace glidelab::core {

std::optional<LengthUnit> unit_of_long_run(double range_m) {
  if (range_m > kLongestRun_m) return likely_unit(range_m, kUsualRun_m);
  return std::nullopt;
}

Found::Found(const Found&) = default;
Found::Found(Found&&) noexcept = default;
Found& Found::operator=(const Found&) = default;
Found& Found::operator=(Found&&) noexcept = default;
Found::~Found() = default;

namespace found {
namespace {

std::string units_text(const BeyondGravity& of) {
  std::string units;
  for (std::size_t i = 0; i < of.units.size(); ++i) {
    units += i == 0 ? "" : i + 1 < of.units.size() ? ", " : " or ";
    units += name_of(of.units[i]).many;
  }
  if (units.empty()) units = "another unit";
  return of.fall ? units + " (this would be a free fall)" : units;
}

struct FaultSentence {
  FaultWords operator()(const Oscillation& of) const {
    return {fmt::format("the motion turns {} times, and its acceleration depends on position: this is an oscillation, "
                        "not a run along an incline",
                        of.turns),
            "the law contains no spring; if one stretch between turns is a free run, select it with start_s and end_s"};
  }
  FaultWords operator()(const BeyondGravity& of) const {
    return {fmt::format("its accelerations are about {:.3g} m/s², {:.2g} times gravity: no incline can produce that",
                        of.acceleration_m_s2, of.acceleration_m_s2 / of.gravity_m_s2),
            fmt::format("x may be in {} instead of metres, or an angle, or the times in another unit: convert the "
                        "file, or state the scale",
                        units_text(of))};
  }
  FaultWords operator()(const FreeFall& of) const {
    return {
        fmt::format("its accelerations are about {:.2g} times gravity: this is free fall, but incline_deg is {:.3g}",
                    of.over_gravity, of.incline_deg),
        "state incline_deg = 90 for a fall; otherwise check the unit of x"};
  }
  FaultWords operator()(const CurvedPath& of) const {
    return {fmt::format("the path in the image is curved (sagitta {:.3g} % of its length): the track is not straight",
                        100.0 * of.bend),
            "the law of motion holds along a straight line: film a straight track, not a free flight or a swing"};
  }
  FaultWords operator()(const Counted& of) const {
    return std::abs(of.step) == 1.0
               ? FaultWords{"x changes by exactly 1 from row to row: it counts something, and is no position",
                            "say which column holds the positions (--column)"}
               : FaultWords{fmt::format("x changes by {:.6g} from row to row, a multiple of a quarter turn: it is an "
                                        "angle, and no position",
                                        of.step),
                            "give positions along a straight line"};
  }
  FaultWords operator()(const LostInNoise& of) const {
    return {fmt::format("the positions scatter by {:.2g} m (one standard deviation) over a distance of {:.2g} m: no "
                        "motion shows",
                        of.noise_m, of.distance_m),
            "see whether the tracker or the sensor followed the body; record again with less scatter"};
  }
  FaultWords operator()(const AtRest& of) const {
    return {of.spread_m > 0.0
                ? fmt::format("nothing moves: the positions scatter by {:.2g} m about one place", of.spread_m)
                : "nothing moves: all positions are the same",
            "record a body that moves; if it did move, see whether the tracker or the sensor followed it"};
  }
};

}  // namespace

FaultWords fault_words(const MotionFault& fault) {
  return std::visit(FaultSentence{}, fault);
}

}  // namespace found

bool is_playback(double file_hz, double stated_hz) {
  constexpr double kFastestPlayed_hz = 61.0, kLeastSlower = 2.9;
  return file_hz < kFastestPlayed_hz && stated_hz > kLeastSlower * file_hz;
}

}  // namespace glidelab::core
