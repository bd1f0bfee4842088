#include "python/binding/given_input.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <utility>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "base/math/angles.h"
#include "core/track/bare_track.h"

namespace glidelab::python {

namespace py = pybind11;

Vector vector_of(std::span<const double> values) {
  return Vector(static_cast<py::ssize_t>(values.size()), values.data());
}

namespace {

constexpr double kSteepest_deg = 90.0;   // the limit of experiment.toml
constexpr double kMegabyte = 1048576.0;  // bytes

constexpr std::array<std::pair<const char*, core::Launched>, 4> kLaunches = {{{"up", core::Launched::up},
                                                                              {"down", core::Launched::down},
                                                                              {"released", core::Launched::released},
                                                                              {"unknown", core::Launched::unknown}}};

std::string named(const GivenTrack& track) {
  return fmt::format("track \"{}\"", track.name);
}

void require(bool holds, const GivenTrack& track, const char* key, const std::string& found, const char* expected,
             std::vector<base::Issue>& issues) {
  if (!holds) issues.push_back({named(track), 0, key, found, expected});
}

core::ClipSetup setup_of(const GivenTrack& track, std::vector<base::Issue>& issues) {
  const auto number = [](double value) { return fmt::format("{}", value); };
  const double mass_kg = track.mass_kg.value_or(1.0);
  require(std::isfinite(mass_kg) && mass_kg > 0.0, track, "mass_kg", number(mass_kg), "a number above 0", issues);
  require(std::isfinite(track.mass_sd_kg) && track.mass_sd_kg >= 0.0, track, "mass_sd_kg", number(track.mass_sd_kg),
          "a number of 0 or more", issues);
  require(std::abs(track.incline_deg) <= kSteepest_deg, track, "incline_deg", number(track.incline_deg),
          "a number from -90 to 90", issues);
  const double incline_sd_deg = track.incline_sd_deg.value_or(1.0);
  require(std::isfinite(incline_sd_deg) && incline_sd_deg >= 0.0, track, "incline_sd_deg", number(incline_sd_deg),
          "a number of 0 or more, or None", issues);

  core::ClipSetup setup;
  setup.name = track.name;
  setup.mass_kg = mass_kg;
  setup.mass_sd_kg = track.mass_sd_kg;
  setup.incline_rad = track.incline_deg * base::kRadPerDegree;
  if (track.incline_sd_deg) setup.incline_sd_rad = *track.incline_sd_deg * base::kRadPerDegree;
  setup.group = track.group;
  bool known = false;
  for (const auto& [word, launched] : kLaunches) {
    if (track.launched != word) continue;
    setup.launched = launched;
    known = true;
  }
  setup.incline_assumed =
      setup.launched == core::Launched::unknown && setup.incline_rad == 0.0 && !track.incline_sd_deg;
  require(known, track, "launched", fmt::format("\"{}\"", track.launched), "up, down, released or unknown", issues);
  return setup;
}

void check_readings(const std::vector<GivenTrack>& given, const std::vector<core::ClipSetup>& setups,
                    std::vector<base::Issue>& issues) {
  for (std::size_t i = 0; i < setups.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (setups[i].group != setups[j].group || !core::contradicts(setups[i], setups[j])) continue;
      issues.push_back(
          {named(given[i]), 0, "incline_deg", fmt::format("{}", given[i].incline_deg),
           fmt::format("{} as in {}: a group has one inclination", given[j].incline_deg, named(given[j]))});
      break;
    }
  }
}

}  // namespace

GivenTracks read_tracks(std::vector<GivenTrack> given) {
  std::vector<base::Issue> issues;
  if (given.empty()) issues.push_back({"", 0, "tracks", "none", "one or more"});
  GivenTracks read;
  std::set<std::string> names;
  for (GivenTrack& track : given) {
    require(!track.name.empty() && names.insert(track.name).second, track, "name",
            track.name.empty() ? "nothing" : "it a second time", "a name of its own", issues);
    read.setups.push_back(setup_of(track, issues));
    try {
      read.tracks.push_back(
          core::track_of_numbers(std::move(track.t_s), std::move(track.x_m), std::move(track.force_n), named(track)));
    } catch (const base::InputError& error) {
      issues.insert(issues.end(), error.issues().begin(), error.issues().end());
      continue;
    }
    require(track.mass_kg || read.tracks.back().force_n.empty(), track, "mass_kg", "none, with a recorded force",
            "the moving mass in kilograms: the force accelerates it by F/m", issues);
    if (!track.mass_kg) read.tracks.back().notes.emplace_back(core::AssumedMass{});
  }
  core::name_groups(read.setups);
  check_readings(given, read.setups, issues);
  if (!issues.empty()) throw base::InputError(std::move(issues));
  return read;
}

core::Gravity read_gravity(const GivenGravity& given) {
  const auto& [m_s2, sd_m_s2] = given;
  if (m_s2 && !(std::isfinite(*m_s2) && *m_s2 > 0.0)) {
    throw base::InputError(base::Issue{"", 0, "gravity_m_s2", fmt::format("{}", *m_s2), "a number above 0"});
  }
  if (sd_m_s2 && !(m_s2 && std::isfinite(*sd_m_s2) && *sd_m_s2 >= 0.0)) {
    throw base::InputError(base::Issue{"", 0, "gravity_sd_m_s2", fmt::format("{}", *sd_m_s2),
                                       "a number from 0 on, and gravity_m_s2, whose uncertainty it is"});
  }
  return core::stated_gravity(m_s2, sd_m_s2);
}

std::string text_of(const GivenScenario& given) {
  return given.second ? *given.second : base::read_file(given.first);
}

render::Scenario read_scenario(const GivenScenario& given, render::ScenarioChecks checks) {
  try {
    return render::read_scenario(text_of(given), given.first, checks);
  } catch (const base::InputError& error) {
    if (!given.second) throw;
    std::vector<base::Issue> issues = error.issues();
    for (base::Issue& issue : issues) {
      if (issue.file == given.first) issue.line = 0;  // a dict has no lines
    }
    throw base::InputError(std::move(issues));
  }
}

std::optional<fit::OutsideEstimator> outside_of(const std::optional<GivenEstimator>& given,
                                                const WatchedWork& watched) {
  if (!given) return std::nullopt;
  fit::OutsideEstimator made = fit::outside_estimator(given->command, given->name);
  made.function = given->function;
  made.limits.wall_s = given->seconds;
  made.limits.memory_bytes = static_cast<std::uint64_t>(given->megabytes * kMegabyte);
  made.stop = [&watched] { return watched.stopped(); };
  return made;
}

void bind_given_input(py::module_& module) {
  py::class_<GivenTrack>(module, "GivenTrack")
      .def(py::init([](std::string name, const Vector& t_s, const Vector& x_m, const Vector& force_n,
                       std::optional<double> mass_kg, double mass_sd_kg, double incline_deg,
                       std::optional<double> incline_sd_deg, std::string launched, std::string group) {
        return GivenTrack{std::move(name), copy_of(t_s), copy_of(x_m),   copy_of(force_n),    mass_kg,
                          mass_sd_kg,      incline_deg,  incline_sd_deg, std::move(launched), std::move(group)};
      }));
  py::class_<GivenEstimator>(module, "EstimatorCommand")
      .def(py::init([](std::string command, std::string name, std::string function, double seconds, double megabytes) {
        return GivenEstimator{std::move(command), std::move(name), std::move(function), seconds, megabytes};
      }));
}

}  // namespace glidelab::python
