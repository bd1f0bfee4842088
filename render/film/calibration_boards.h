/// The poses in which the chessboard is held before the camera.
#pragma once

#include <cstdint>
#include <vector>

#include "render/scenario/scenario.h"
#include "render/scenario/static_scene.h"

namespace glidelab::render {

/// The boards of the calibration views: poses that fill different parts of the image, tilted up to 35 degrees, jittered
/// by `seed`, each wholly visible with its white border. NumericalError where no such pose is found.
std::vector<Chessboard> calibration_boards(const Scenario& scenario, std::uint64_t seed);

}  // namespace glidelab::render
