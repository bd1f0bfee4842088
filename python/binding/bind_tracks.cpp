/// made_tracks: the motions of a scenario as positions with noise, with their truth, for the user's own estimators.
#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cmath>
#include <utility>

#include "base/errors.h"
#include "base/math/angles.h"
#include "core/result/quantity.h"
#include "python/binding/bindings.h"
#include "python/binding/given_input.h"
#include "validate/made_tracks/made_tracks.h"

namespace glidelab::python {

namespace py = pybind11;

namespace {

py::dict track_dict(const core::ClipSetup& setup, const core::TrackData& track) {
  py::dict fields;  // of glidelab.Track
  fields["t_s"] = vector_of(track.t_s);
  fields["x_m"] = vector_of(track.x_m);
  fields["mass_kg"] = setup.mass_kg;
  fields["incline_deg"] = setup.incline_rad * base::kDegreesPerRad;
  fields["name"] = setup.name;
  if (setup.incline_sd_rad) fields["incline_sd_deg"] = *setup.incline_sd_rad * base::kDegreesPerRad;
  fields["launched"] = core::name_of(setup.launched);
  fields["group"] = setup.group;
  return fields;
}

/// The truths of each configuration by quantity, None for a quantity that the scenario does not have.
py::list truth_list(const validate::Truth& truth) {
  py::list list;
  for (const validate::TrueConfiguration& of : truth.configurations) {
    py::dict quantities;
    for (const core::QuantityName& quantity : core::kQuantities) {
      quantities[py::str(std::string(quantity.key))] = core::value_of(of, quantity.which);
    }
    list.append(py::make_tuple(of.name, of.clips, std::move(quantities)));
  }
  return list;
}

/// (tracks, truths, gravity): one experiment for each seed, with the scenario read and simulated once.
class TrackMaker {
 public:
  TrackMaker(const GivenScenario& given, double noise_m)
      : scenario_(read_scenario(given, render::ScenarioChecks::values)), noise_m_(noise_m) {
    if (!(std::isfinite(noise_m) && noise_m > 0.0)) {
      throw base::InputError(base::Issue{"", 0, "noise_m", fmt::format("{}", noise_m), "a number of metres above 0"});
    }
  }

  std::uint64_t seed() const { return scenario_.seed; }

  py::tuple make(std::uint64_t seed) const {
    validate::MadeTracks made;
    {
      const py::gil_scoped_release without_lock;
      made = validate::with_noise(validate::make_tracks(scenario_, seed), noise_m_, seed);
    }
    py::list tracks;
    for (std::size_t c = 0; c < made.tracks.size(); ++c) tracks.append(track_dict(made.setups[c], made.tracks[c]));
    return py::make_tuple(std::move(tracks), truth_list(made.truth), made.gravity_m_s2);
  }

 private:
  render::Scenario scenario_;
  double noise_m_;
};

}  // namespace

void bind_tracks(py::module_& module) {
  py::class_<TrackMaker>(module, "TrackMaker")
      .def(py::init<const GivenScenario&, double>())
      .def_property_readonly("seed", &TrackMaker::seed)
      .def("make", &TrackMaker::make);
}

}  // namespace glidelab::python
