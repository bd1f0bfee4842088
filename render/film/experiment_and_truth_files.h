/// The text files of the two folders: experiment.toml, and the truth beside it.
#pragma once

#include <cstdint>
#include <string>

#include "render/scenario/scenario.h"

namespace glidelab::render {

/// Names within the experiment folder, of the i-th of `count` images.
std::string view_name(std::size_t i);
std::string plane_name(std::size_t i, std::size_t count);

/// experiment.toml: what a person would write who took these images; no truth in it.
std::string experiment_toml(const Scenario& scenario);

/// truth.json: what was put in. The seed is the one that was used.
std::string truth_json(const Scenario& scenario, std::uint64_t seed);

/// Where the pattern's first corner, projected on the line of motion of this inclination, lies on the track.
double x_origin_m(const Scenario& scenario, double incline_rad);

}  // namespace glidelab::render
