#include "validate/blind/case/blind_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "base/math/angles.h"
#include "base/text/json_text.h"
#include "validate/blind/case/blind_effects.h"
#include "validate/blind/case/blind_strength.h"
#include "validate/random_use.h"

namespace glidelab::validate {
namespace {

// Of 100 cases: 20 nominal, 50 with one effect, 12 with two, 18 with one outside.
constexpr double kUpToNone = 0.20, kUpToSingle = 0.70, kUpToPair = 0.82;
constexpr double kLeastGain = 8.0, kMostGain = 1500.0;  // a factor of 3000 of all, and of odds from 1 to a thousand
constexpr double kLeastPairGain = 30.0;                 // gain of each of two causes beside the other
constexpr int kMostDraws = 400;

BlindCause cause_of(const BlindEffect& effect, double size, double gain) {
  return {effect.id, size, effect.truth ? effect.truth(size) : std::map<std::string, double>{}, effect.variable, gain};
}

/// Draws effects for a design; false if they cannot be seen in it.
bool draw_causes(BlindCase& one, const BlindDraw& draw, BlindRandom& random, std::vector<BlindEffect>& effects) {
  if (one.kind == BlindKind::none) return true;
  const BlindDetection detection(one.design, draw.look);
  const std::size_t many = one.kind == BlindKind::pair ? 2 : 1;
  const auto& ids = one.kind == BlindKind::outside ? outside_effects() : library_effects();
  for (std::size_t e = 0; e < many; ++e) {
    const std::string id = draw.only.empty() ? one_of(ids, random) : draw.only;
    if (e == 1 && id == effects.front().id) return false;
    const double wanted = log_uniform(random, many == 2 ? kLeastPairGain : kLeastGain, kMostGain);
    effects.push_back(draw_effect(id, one.design, random));
    const std::optional<BlindStrength> found = size_for(detection, effects.back(), wanted);
    if (!found) return false;
    one.causes.push_back(cause_of(effects.back(), found->size, found->gain));
  }
  if (many == 1) return true;
  for (std::size_t e = 0; e < 2; ++e) {
    const BlindEffect &mine = effects[e], &other = effects[1 - e];
    if (mine.gain || other.gain) continue;  // affects single frames: nothing smooth absorbs it
    one.causes[e].gain = detection.gain_beside({&mine, one.causes[e].size}, {&other, one.causes[1 - e].size});
    if (one.causes[e].gain < 0.5 * kLeastPairGain) return false;  // the two look the same here
  }
  return true;
}

void film_case(BlindCase& one, const std::vector<BlindEffect>& effects, BlindRandom& random) {
  std::vector<BlindPut> puts;
  for (std::size_t e = 0; e < effects.size(); ++e) puts.push_back({&effects[e], one.causes[e].size});
  // A camera keeps filming when the glider rests: positions there are those at rest.
  for (std::size_t c = 0; c < one.design.clips.size(); ++c) {
    BlindFilm film = nominal_film(one.design, one.design.clips[c]);
    for (const BlindPut& put : puts) put.effect->put(put.size, c, film);
    const auto motion = blind_motion(film.law, one.design.clips[c].x0_m, one.design.clips[c].v0_m_s, film.true_t_s);
    one.x_m.emplace_back();
    for (std::size_t k = 0; k < motion.size(); ++k) {
      double x = motion[k].x_m;
      for (const auto& see : film.seen) x = see(x, film.true_t_s[k]);
      one.x_m.back().push_back(x + film.off_m[k] + one.design.noise_sd_m * normal(random));
    }
  }
}

bool all_finite(const std::vector<double>& x) {
  return std::all_of(x.begin(), x.end(), [](double value) { return std::isfinite(value); });
}

BlindKind kind_of(BlindRandom& random, const BlindDraw& draw) {
  const double lot = uniform(random, 0.0, 1.0);
  if (!draw.only.empty()) {
    const auto& outside = outside_effects();
    return std::find(outside.begin(), outside.end(), draw.only) != outside.end() ? BlindKind::outside
                                                                                 : BlindKind::single;
  }
  return lot < kUpToNone     ? BlindKind::none
         : lot < kUpToSingle ? BlindKind::single
         : lot < kUpToPair   ? BlindKind::pair
                             : BlindKind::outside;
}

}  // namespace

std::string_view word(BlindKind kind) {
  switch (kind) {
    case BlindKind::none:
      return "none";
    case BlindKind::single:
      return "single";
    case BlindKind::pair:
      return "pair";
    case BlindKind::outside:
      return "outside";
  }
  return "none";
}

BlindCase make_blind_case(std::uint64_t seed, std::size_t index, const BlindDraw& draw) {
  BlindRandom random = random_engine(RandomUse::by_number, seed, index);
  const BlindKind kind = kind_of(random, draw);
  for (int attempt = 0; attempt < kMostDraws; ++attempt) {
    BlindCase one;
    one.seed = seed;
    one.index = index;
    one.kind = kind;
    one.design = draw_design(random);
    std::vector<BlindEffect> effects;
    if (!draw_causes(one, draw, random, effects)) continue;
    film_case(one, effects, random);
    if (std::all_of(one.x_m.begin(), one.x_m.end(), all_finite)) return one;
  }
  throw base::NumericalError(
      fmt::format("blind case {} of seed {}: none of {} designs shows the effect", index, seed, kMostDraws));
}

void write_blind_folder(const BlindCase& one, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder / "tracks");
  // The motions have exactly this gravity, which alone would be that of no particular place.
  std::string toml = fmt::format(
      "format = 1\nname = \"case {}\"\ngravity_m_s2 = {}\ngravity_sd_m_s2 = 0.0\n\n[track]\ndownhill = \"+X\"\n",
      one.index, one.design.gravity_m_s2);
  for (std::size_t c = 0; c < one.design.clips.size(); ++c) {
    const BlindClip& clip = one.design.clips[c];
    const BlindGroup& group = one.design.groups[clip.group];
    const BlindMass& mass = one.design.masses[clip.mass];
    toml += fmt::format(
        "\n[[clip]]\nname = \"{0}\"\ntrack = \"tracks/{0}.csv\"\nmass_kg = {1:.6g}\nincline_deg = {2:.6g}\nlaunched = "
        "\"{3}\"\ngroup = \"{4}\"\n",
        clip.name, mass.stated_kg, group.stated_rad * base::kDegreesPerRad, clip.v0_m_s < 0.0 ? "up" : "down",
        group.name);
    if (group.stated_sd_rad)
      toml += fmt::format("incline_sd_deg = {:.6g}\n", *group.stated_sd_rad * base::kDegreesPerRad);
    if (mass.sd_kg > 0.0) toml += fmt::format("mass_sd_kg = {:.6g}\n", mass.sd_kg);
    std::string csv = "t_s,x_m\n";
    for (std::size_t k = 0; k < one.x_m[c].size(); ++k) {
      csv += fmt::format("{:.9f},{:.8f}\n", static_cast<double>(k) / clip.rate_hz, one.x_m[c][k]);
    }
    base::write_file(folder / "tracks" / (clip.name + ".csv"), csv);
  }
  base::write_file(folder / "experiment.toml", toml);
}

nlohmann::ordered_json truth_of(const DrawnCase& one) {
  nlohmann::ordered_json truth;
  truth["format"] = 1;
  truth["seed"] = one.seed;
  truth["case"] = one.index;
  truth["kind"] = word(one.kind);
  truth["causes"] = nlohmann::ordered_json::array();
  for (const BlindCause& cause : one.causes) {
    nlohmann::ordered_json object{{"id", cause.id}, {"size", cause.size}, {"log_likelihood_gain", cause.gain}};
    object["parameters"] = cause.parameters;
    if (!cause.variable.empty()) object["variable"] = cause.variable;
    truth["causes"].push_back(std::move(object));
  }
  return truth;
}

std::string blind_truth_json(const BlindCase& one) {
  nlohmann::ordered_json truth = truth_of(one);
  truth["k_n_s_m"] = one.design.k_n_s_m;
  truth["mu"] = one.design.mu;
  truth["noise_sd_m"] = one.design.noise_sd_m;
  truth["alpha_rad"] = nlohmann::ordered_json::object();
  for (const BlindGroup& group : one.design.groups) truth["alpha_rad"][group.name] = group.true_rad;
  truth["mass_kg"] = nlohmann::ordered_json::array();
  for (const BlindMass& mass : one.design.masses) truth["mass_kg"].push_back(mass.true_kg);
  return base::json_text(truth) + "\n";
}

}  // namespace glidelab::validate
