/// What is done to a rendered experiment folder before it is a filmed blind case: lines of experiment.toml that say
/// something else, frames that are lost, clips drawn anew with the glider where it is not, clips filed anew without
/// loss.
///
/// A glider that is shown elsewhere is drawn there, by the same camera with the same noise, with a marker of the same
/// shape (a lens that shifts it by x² or x³ would stretch it by some percent). Its images are not pulled instead: one
/// whose edges are sharper than its pixels cannot be pulled by parts of a pixel, and centres would be off by up to
/// 0.03 px, in beats of some centimetres that no lens makes.
#pragma once

#include <filesystem>

#include "render/scenario/scenario.h"
#include "validate/blind/case/blind_scene.h"

namespace glidelab::validate {

/// Changes the folder that was rendered from this scenario in place. A line of experiment.toml that is to be changed
/// and is not there: std::logic_error.
void retouch_folder(const BlindScene& scene, const render::Scenario& scenario, const std::filesystem::path& folder);

}  // namespace glidelab::validate
