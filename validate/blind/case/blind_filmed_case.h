/// One filmed blind case: a small experiment rendered by the program's own renderer in a process of its own, with
/// nothing (25 of 100), one effect (57) or one not on the list (18). Its folder does not say which.
///
/// It is drawn from (seed, index) alone: scene, cause and strength (blind_filmed_effects.h; 8 to 1500). The folder
/// shown to the diagnosis is what the renderer wrote, less what is withheld. The scenario, the renderer's own truth and
/// all that was done to the images are kept from it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "render/scenario/scenario.h"
#include "validate/blind/case/blind_case.h"
#include "validate/blind/case/blind_scene.h"

namespace glidelab::validate {

/// Changes a folder that was rendered from this scenario, in place, before it is a filmed blind case: lines of
/// experiment.toml say something else, frames are lost, clips are drawn anew with the glider where it is not, or are
/// filed anew without loss. A line of experiment.toml that is to be changed and is not there: std::logic_error.
///
/// A glider that is shown elsewhere is drawn there, by the same camera with the same noise, with a marker of the same
/// shape (a lens that shifts it by x² or x³ would stretch it by some percent). Its images are not pulled instead: one
/// whose edges are sharper than its pixels cannot be pulled by parts of a pixel, and centres would be off by up to 0.03
/// px, in beats of some centimetres that no lens makes.
void retouch_folder(const BlindScene& scene, const render::Scenario& scenario, const std::filesystem::path& folder);

struct FilmedCase : DrawnCase {
  BlindScene scene;
  /// Effects that act and are no secret: a file with loss says so itself. To name them is neither asked for nor wrong.
  std::vector<std::string> told;

  std::string scenario() const;
};

/// NumericalError where no scene of many shows the wanted effect.
FilmedCase make_filmed_case(std::uint64_t seed, std::size_t index, const BlindDraw& draw = {});

/// Renders a scenario file into a folder that is not there yet, in another process; returns "" or what went wrong.
using FilmRenderer =
    std::function<std::string(const std::filesystem::path& scenario, const std::filesystem::path& folder)>;

/// The experiment folder; `scratch` is used meanwhile and is gone afterwards. EnvironmentError where rendering fails.
void film_blind_folder(const FilmedCase& one, const std::filesystem::path& folder, const std::filesystem::path& scratch,
                       const FilmRenderer& render);

/// truth_of(), the noise, what is no secret, what experiment.toml says otherwise, and the scenario that was rendered.
std::string filmed_truth_json(const FilmedCase& one);

}  // namespace glidelab::validate
