// Track files by themselves count x from origins of their own: nothing may depend on where these lie.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "core/experiment/clip_setup.h"
#include "core/track/bare_track.h"
#include "diagnose/effects/effect_library.h"
#include "diagnose/verdict/diagnose.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;

namespace {

/// Two paper cups whose origins are apart: x = v²/g ln cosh(g t/v), seen with a scale that varies by 2 mm on the way.
diagnose::Diagnosis of_cups(double apart_m, core::RecordedBy recorded_by = core::RecordedBy::unstated) {
  const tests::TempDir temp;
  std::mt19937_64 random(5);
  std::normal_distribution<double> noise(0.0, 3e-4);
  std::vector<std::filesystem::path> files;
  for (const double mass_kg : {1e-3, 2e-3}) {
    files.push_back(temp / fmt::format("cup-{:.0f}.csv", 1e3 * mass_kg));
    std::ofstream out(files.back());
    out << "t_s,x_m\n";
    const double g = 9.80665, v = 1.7 * std::sqrt(mass_kg / 1e-3);
    for (int i = 0; i < 42; ++i) {
      const double t = i / 60.0, fallen = v * v / g * std::log(std::cosh(g * t / v));
      const double seen = fallen + 2e-3 * std::sin(2.0 * std::numbers::pi * fallen / 0.45) + noise(random);
      out << fmt::format("{:.6f},{:.6f}\n", t, seen + (files.size() > 1 ? apart_m : 0.0));
    }
  }
  diagnose::DiagnoseOptions how{.without = {}, .jobs = 2};
  how.bare.incline_deg = 90.0;
  how.bare.masses_kg = {1e-3, 2e-3};
  how.bare.recorded_by = recorded_by;
  how.bare = core::masses_of_files(how.bare, files);
  return diagnose::diagnose(files, how);
}

bool leaves_places_out(const diagnose::Diagnosis& diagnosis) {
  return std::ranges::any_of(diagnosis.notes, [](const diagnose::Note& note) {
    const auto* const origin = std::get_if<diagnose::OneOrigin>(&note);
    return origin != nullptr && origin->left_out;
  });
}

}  // namespace

TEST_CASE("where files count x from does not change their diagnosis, and no cause at a place is named") {
  const diagnose::Diagnosis here = of_cups(0.0), there = of_cups(0.45);
  CHECK(leaves_places_out(here));
  REQUIRE(here.gap);
  REQUIRE(there.gap);
  CHECK(there.verdict == here.verdict);
  CHECK(there.gap->before == Approx(here.gap->before).epsilon(1e-3));
  CHECK(there.gap->after == Approx(here.gap->after).epsilon(1e-2));
  REQUIRE(there.effects.size() == here.effects.size());
  for (std::size_t e = 0; e < here.effects.size(); ++e) {
    CHECK(there.effects[e].id == here.effects[e].id);
  }
  for (const diagnose::Diagnosis* of : {&here, &there}) {
    for (const auto& effect : of->effects) {
      CAPTURE(effect.id);
      CHECK_FALSE(diagnose::is_bound_to_place(diagnose::effect_index(effect.id)));
    }
    for (const auto& cause : of->explained) {
      CAPTURE(cause.id);
      CHECK_FALSE(diagnose::is_bound_to_place(diagnose::effect_index(cause.id)));
    }
  }
}

TEST_CASE("a sensor stays where it is: its files share an origin") {
  CHECK_FALSE(leaves_places_out(of_cups(0.0, core::RecordedBy::sensor)));
}

TEST_CASE("cables, bumpers and what varies along x are bound to a place, drags and clocks are not") {
  for (const char* id :
       {diagnose::ids::tether, diagnose::ids::end_stop, diagnose::ids::place_friction, diagnose::ids::track_bow,
        diagnose::ids::damping_gradient, diagnose::ids::lens_distortion, diagnose::ids::perspective_error}) {
    CAPTURE(id);
    CHECK(diagnose::is_bound_to_place(diagnose::effect_index(id)));
  }
  for (const char* id : {diagnose::ids::quadratic_drag, diagnose::ids::rotational_inertia, diagnose::ids::scale_error,
                         diagnose::ids::frame_rate_error, diagnose::ids::late_release, diagnose::ids::camera_motion,
                         diagnose::ids::load_independent_friction, diagnose::ids::clip_scatter}) {
    CAPTURE(id);
    CHECK_FALSE(diagnose::is_bound_to_place(diagnose::effect_index(id)));
  }
}
