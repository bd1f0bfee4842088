/// What Python gives, converted for the rooms: motions as arrays, with what experiment.toml states about a clip;
/// gravity; a scenario; an outside estimator.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/experiment/clip_setup.h"
#include "core/experiment/local_gravity.h"
#include "core/track/track_data.h"
#include "fit/outside/outside_estimator.h"
#include "python/binding/watched_work.h"
#include "render/scenario/scenario.h"

namespace glidelab::python {

/// One dimension, contiguous: glidelab/_checks.py converts it, and reports an error if it cannot.
using Vector = pybind11::array_t<double, pybind11::array::c_style>;

inline std::span<const double> span_of(const Vector& vector) {
  return {vector.data(), static_cast<std::size_t>(vector.size())};
}
inline std::vector<double> copy_of(const Vector& vector) {
  return {vector.data(), vector.data() + vector.size()};
}
Vector vector_of(std::span<const double> values);

/// The keys of a clip in experiment.toml; NaN and empty if nothing is stated.
struct GivenTrack {
  std::string name;
  std::vector<double> t_s, x_m, force_n;
  std::optional<double> mass_kg;  ///< 1 kg, with a note, if none is stated
  double mass_sd_kg = 0.0;
  double incline_deg = 0.0;
  std::optional<double> incline_sd_deg;
  std::string launched;  ///< up, down, released, unknown
  std::string group;
};

struct GivenTracks {
  std::vector<core::ClipSetup> setups;
  std::vector<core::TrackData> tracks;
};

/// InputError for an invalid clip: numbers that do not form a track, an invalid mass, a name used twice, an unknown
/// word for the launch, readings of one group's inclination that contradict each other.
GivenTracks read_tracks(std::vector<GivenTrack> given);

/// Gravity and its standard deviation as stated; core::stated_gravity() says what is taken where they are not.
using GivenGravity = std::pair<std::optional<double>, std::optional<double>>;

/// InputError if it is not an acceleration above 0, or if only its standard deviation is stated.
core::Gravity read_gravity(const GivenGravity& given);

/// A scenario: (file, text). Without a text the file is read; with one, into which a dict was converted, `file` is its
/// name in messages, and a camera file is relative to its folder.
using GivenScenario = std::pair<std::string, std::optional<std::string>>;

/// InputError as in render::read_scenario().
render::Scenario read_scenario(const GivenScenario& given, render::ScenarioChecks checks = render::ScenarioChecks::all);

/// Its text.
std::string text_of(const GivenScenario& given);

/// An outside estimator: a command and its limits.
struct GivenEstimator {
  std::string command;
  std::string name;      ///< empty: from the command
  std::string function;  ///< that the command calls; empty: none
  double seconds = 0.0;
  double megabytes = 0.0;
};

/// Empty if there is none. An interrupt of the watched work ends the estimator's program. InputError as in
/// fit::outside_estimator().
std::optional<fit::OutsideEstimator> outside_of(const std::optional<GivenEstimator>& given, const WatchedWork& watched);

/// glidelab._glidelab.GivenTrack and EstimatorCommand.
void bind_given_input(pybind11::module_& module);

}  // namespace glidelab::python
