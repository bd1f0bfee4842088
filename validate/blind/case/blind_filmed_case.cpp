#include "validate/blind/case/blind_filmed_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/files/staged_output.h"
#include "diagnose/effects/effect_list.h"
#include "validate/blind/case/blind_retouch.h"
#include "validate/blind/case/blind_scene_effects.h"

namespace glidelab::validate {
namespace {

namespace fs = std::filesystem;

constexpr double kFilmedNone = 0.25, kFilmedSingle = 0.82;
constexpr double kFilmedLeastGain = 8.0, kFilmedMostGain = 1500.0;
constexpr int kMostScenes = 400;
constexpr std::uint32_t kFilmed = 0x66696c6d;  // so that filmed cases are no tracks' cases of the same seed

bool outside(const std::string& id) {
  const auto& ids = filmed_outside_effects();
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

}  // namespace

std::string FilmedCase::scenario() const {
  return scenario_text(scene, fmt::format("case {}", index), 1000003 * seed + index + 1);
}

FilmedCase make_filmed_case(std::uint64_t seed, std::size_t index, const BlindDraw& draw) {
  std::seed_seq sequence{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                         static_cast<std::uint32_t>(index), kFilmed};
  BlindRandom random(sequence);
  FilmedCase one;
  one.seed = seed;
  one.index = index;
  const double lot = uniform(random, 0.0, 1.0);
  if (!draw.only.empty()) {
    one.kind = outside(draw.only) ? BlindKind::outside : BlindKind::single;
  } else {
    one.kind = lot < kFilmedNone ? BlindKind::none : lot < kFilmedSingle ? BlindKind::single : BlindKind::outside;
  }
  for (int attempt = 0; attempt < kMostScenes; ++attempt) {
    const auto& ids = one.kind == BlindKind::outside ? filmed_outside_effects() : filmed_effects();
    const std::string id = one.kind == BlindKind::none ? "" : draw.only.empty() ? one_of(ids, random) : draw.only;
    const double wanted = log_uniform(random, kFilmedLeastGain, kFilmedMostGain);
    one.scene = draw_scene(random, needs_lossless(id));
    one.told.clear();
    if (one.scene.camera.lossy()) one.told.emplace_back(diagnose::ids::compression);
    if (id.empty()) return one;
    const auto cause = put_filmed_effect(id, wanted, one.scene, random);
    if (!cause) continue;
    one.causes = {*cause};
    return one;
  }
  throw base::NumericalError(
      fmt::format("filmed case {} of seed {}: none of {} scenes shows the effect", index, seed, kMostScenes));
}

void film_blind_folder(const FilmedCase& one, const fs::path& folder, const fs::path& scratch,
                       const FilmRenderer& render) {
  fs::remove_all(scratch);
  fs::create_directories(scratch);
  fs::create_directories(folder.parent_path());
  base::write_file(scratch / "scenario.toml", one.scenario());
  const std::string failure = render(scratch / "scenario.toml", scratch / "case");
  if (!failure.empty()) {
    throw base::EnvironmentError(fmt::format("rendering blind case {} of seed {}: {}", one.index, one.seed, failure));
  }
  retouch_folder(one.scene, render::read_scenario(scratch / "scenario.toml"), scratch / "case");
  fs::rename(scratch / "case", folder);
  fs::remove_all(scratch);
}

std::string filmed_truth_json(const FilmedCase& one) {
  nlohmann::ordered_json truth = truth_of(one);
  truth["told"] = one.told;
  truth["noise_m"] = one.scene.motion.noise_sd_m;
  truth["stated"] = nlohmann::ordered_json::object();
  for (const BlindStated& stated : one.scene.stated) truth["stated"][stated.key] = stated.value;
  truth["filed_anew"] = one.scene.retouch.rewritten;
  truth["scenario"] = one.scenario();
  return truth.dump(2) + "\n";
}

}  // namespace glidelab::validate
