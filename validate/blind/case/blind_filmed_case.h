/// One filmed blind case: a small experiment rendered by the program's own renderer in a process of its own, with
/// nothing (25 of 100), one effect (57) or one not on the list (18). Its folder does not say which.
///
/// It is drawn from (seed, index) alone: scene, cause and strength (blind_filmed_effects.h; 8 to 1500). The folder
/// shown to the diagnosis is what the renderer wrote, minus what is withheld. The scenario, the renderer's own truth
/// and all changes to the images are hidden from it.
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

/// Changes a folder rendered from this scenario, in place, to make it a filmed blind case: lines of experiment.toml are
/// altered, frames are lost, clips are redrawn with the glider displaced, or are rewritten without loss.
/// std::logic_error if a line of experiment.toml that is to be changed does not exist.
///
/// A displaced glider is drawn at its new position, by the same camera with the same noise, with a marker of the same
/// shape (a lens that shifts it by x² or x³ would stretch it by a few percent). The images are not warped instead: an
/// image whose edges are sharper than its pixels cannot be shifted by fractions of a pixel, and centres would be off by
/// up to 0.03 px, in beats of a few centimetres that no lens produces.
void retouch_folder(const BlindScene& scene, const render::Scenario& scenario, const std::filesystem::path& folder);

struct FilmedCase : DrawnCase {
  BlindScene scene;
  /// Effects that act and are not secret: a lossy file states this itself. Naming them is neither required nor wrong.
  std::vector<std::string> told;

  std::string scenario() const;
};

/// NumericalError if none of many scenes shows the requested effect.
FilmedCase make_filmed_case(std::uint64_t seed, std::size_t index, const BlindDraw& draw = {});

/// Renders a scenario file into a folder that does not exist yet, in another process; returns "" or the error.
using FilmRenderer =
    std::function<std::string(const std::filesystem::path& scenario, const std::filesystem::path& folder)>;

/// The experiment folder; `scratch` is used in the meantime and removed afterwards. EnvironmentError if rendering
/// fails.
void film_blind_folder(const FilmedCase& one, const std::filesystem::path& folder, const std::filesystem::path& scratch,
                       const FilmRenderer& render);

/// truth_of(), the noise, what is not secret, the altered statements of experiment.toml, and the rendered scenario.
std::string filmed_truth_json(const FilmedCase& one);

}  // namespace glidelab::validate
