/// The still images of an experiment: views of the hand-held pattern, of the pattern in the plane of motion, and of the
/// plumb line, with the sensor's noise.
#pragma once

#include <opencv2/core.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "render/film/clip_renderer.h"
#include "render/scenario/scenario.h"
#include "render/scenario/scene.h"

namespace glidelab::render {

/// The boards of the calibration views: poses that fill different parts of the image, tilted up to 35 degrees, jittered
/// by `seed`, each entirely visible with its white border. NumericalError if no such pose is found.
std::vector<Chessboard> calibration_boards(const Scenario& scenario, std::uint64_t seed);

std::size_t count_stills(const Scenario& scenario);

/// Called with each still's name within the experiment folder and its 8-bit codes, which are valid only during the
/// call; perhaps from several threads at once.
using StillTaker = std::function<void(const std::string& name, const cv::Mat& codes)>;

/// Their names, in the order in which they are taken.
std::vector<std::string> still_names(const Scenario& scenario);

/// Takes all stills with a stage that was set for the scenario (clip_renderer.h). Still i draws its noise from stream
/// kFirstStillStream + i.
void take_stills(const Scenario& scenario, const Stage& stage, std::uint64_t seed, int jobs, const StillTaker& take);

}  // namespace glidelab::render
