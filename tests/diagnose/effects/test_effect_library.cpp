// What every effect on the list must have. The compiler finds a member that is missing; these tests find one that is
// empty.
#include "diagnose/effects/effect_library.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "base/text/number_text.h"
#include "diagnose/model/track_model.h"
#include "test_paths.h"
#include "tests/catch.h"

using namespace glidelab;
namespace fs = std::filesystem;

namespace {

bool is_scatter(const diagnose::EffectInfo& effect) {
  using diagnose::Search;
  return effect.search == Search::frames || effect.search == Search::noise || effect.search == Search::images ||
         effect.search == Search::rows;
}

/// A glider that runs up, turns and comes back, with every parameter of the effect at a size that shows.
diagnose::TrackModel glider() {
  diagnose::TrackModel model;
  model.mass_kg = 0.4;
  model.k_n_s_m = 0.9;
  model.mu = 0.006;
  model.alpha_rad = 0.07;
  model.x0_m = 0.5;
  model.v0_m_s = -0.6;
  model.x_mid_m = 0.1;
  model.x_mid_all_m = 0.3;
  model.x_low_m = -0.4;
  model.x_high_m = 0.6;
  model.clip = 3;
  static const diagnose::KnownForce known = {{0.0, 0.4, 0.9, 1.5}, {0.05, -0.05, 0.1, 0.0}};
  model.known = &known;
  return model;
}

std::vector<double> times() {
  std::vector<double> t;
  for (int i = 0; i < 120; ++i) t.push_back(i / 80.0);
  return t;
}

/// A size within the range of a parameter, with slow waves, and with places among the positions.
double typical(const diagnose::EffectParameter& parameter) {
  using diagnose::Reach;
  if (parameter.reach == Reach::places) return 0.45;
  if (parameter.reach == Reach::waves) return 3.0;
  if (parameter.reach == Reach::release) return 0.31;
  if (parameter.each == diagnose::Each::motion) return 0.4;
  return parameter.low + 0.05 * (parameter.high - parameter.low);
}

std::string file_text(const std::string& name) {
  std::ifstream file(std::string(tests::kSourceDir) + "/" + name);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

}  // namespace

TEST_CASE("every effect has words, a name, a twin or a reason for none, and what to record next") {
  std::set<std::string_view> names, words;
  for (const diagnose::EffectInfo& effect : diagnose::all_effects()) {
    INFO(effect.id);
    CHECK_FALSE(effect.words.empty());
    CHECK(effect.words.find('.') == std::string_view::npos);  // a phrase, not a sentence
    CHECK_FALSE(effect.name.empty());
    CHECK(effect.name.size() <= 30);
    names.insert(effect.name);
    words.insert(effect.words);
    const int twins = (effect.twin.why_not.empty() ? 0 : 1) + (effect.twin.force != nullptr ? 1 : 0) +
                      (effect.twin.camera != nullptr ? 1 : 0);
    CHECK(twins == 1);
    // If a trajectory shows the effect, the motion of another launch decides.
    if (is_scatter(effect)) CHECK_FALSE(effect.next.empty());
    CHECK((effect.law.moves() ? effect.stage == diagnose::Stage::dynamics : true));
    CHECK((effect.search == diagnose::Search::shape) == (effect.shapes != nullptr));
    CHECK((effect.lines.change == nullptr) == effect.lines.key.empty());
  }
  CHECK(names.size() == diagnose::kEffects);
  CHECK(words.size() == diagnose::kEffects);
}

TEST_CASE("an effect's kin are what its law and its search say") {
  using diagnose::Search;
  for (const diagnose::EffectInfo& effect : diagnose::all_effects()) {
    INFO(effect.id);
    if (effect.drag != diagnose::Drag::none) CHECK(effect.law.resistance != nullptr);
    if (effect.touch != diagnose::Touch::nothing) CHECK(effect.law.force_n != nullptr);
    if (effect.among_clips.of == diagnose::AmongClips::Of::friction) CHECK(effect.law.friction != nullptr);
    if (effect.among_clips.of == diagnose::AmongClips::Of::drag) CHECK(effect.law.resistance != nullptr);
    CHECK((effect.search == Search::noise) == (effect.point_scatter.parameters > 0));
    CHECK(effect.point_scatter.key.empty() == (effect.point_scatter.parameters == 0));
  }
}

TEST_CASE("the mirror of an effect has it for a mirror, and its size there and back is the same") {
  int mirrors = 0;
  for (const diagnose::EffectInfo& effect : diagnose::all_effects()) {
    if (effect.mirror.id.empty()) continue;
    INFO(effect.id);
    const diagnose::EffectInfo& other = diagnose::effect_of(effect.mirror.id);
    CHECK(other.mirror.id == effect.id);
    CHECK(other.mirror.beyond_middle == effect.mirror.beyond_middle);
    CHECK(other.search == effect.search);
    REQUIRE(effect.parameters.size() >= 2);
    // Half a turn and half a turn are a whole one.
    CHECK(std::cos(effect.mirror.phase_rad + other.mirror.phase_rad) == Approx(1.0));
    CHECK((effect.mirror.size == nullptr) == (other.mirror.size == nullptr));
    if (effect.mirror.size != nullptr) {
      CHECK(other.mirror.size(effect.mirror.size(0.3, 2.5), 2.5) == Approx(0.3));
    }
    ++mirrors;
  }
  CHECK(mirrors == 4);
}

TEST_CASE("every parameter of an effect has a key with its unit, a range and a step that resolves it") {
  for (const diagnose::EffectInfo& effect : diagnose::all_effects()) {
    INFO(effect.id);
    const bool fitted = effect.law.moves() || effect.law.seen_m != nullptr || effect.law.stretch != nullptr ||
                        effect.law.row_s != nullptr;
    CHECK(fitted == !effect.parameters.empty());
    if (fitted) CHECK_FALSE(effect.parameters.front().key.empty());
    for (const diagnose::EffectParameter& parameter : effect.parameters) {
      INFO(parameter.key);
      CHECK(parameter.low < parameter.high);
      CHECK(parameter.step > 0.0);
      CHECK(parameter.step < 0.01 * (parameter.high - parameter.low));
      CHECK(diagnose::effect_list()[parameter.slot.effect].id == effect.id);
      if (parameter.key.empty() || parameter.each == diagnose::Each::motion) continue;
      const base::NamedUnit named = base::name_and_unit(parameter.key);
      CHECK_FALSE(named.name.empty());
      CHECK(named.name.find("_m_s") == std::string::npos);  // the unit has been stripped
    }
  }
}

TEST_CASE("the page of effects has a row for every effect, with its name and its parameters") {
  const std::string page = file_text("docs/reference/effects.md");
  REQUIRE_FALSE(page.empty());
  for (const diagnose::EffectInfo& effect : diagnose::all_effects()) {
    INFO(effect.id);
    const std::string row = "| `" + std::string(effect.id) + "` | " + std::string(effect.name) + " |";
    const std::size_t at = page.find(row);
    REQUIRE(at != std::string::npos);
    const std::string line = page.substr(at, page.find('\n', at) - at);
    for (const diagnose::EffectParameter& parameter : effect.parameters) {
      if (parameter.key.empty() || parameter.each == diagnose::Each::motion ||
          effect.id == std::string_view("camera_motion"))
        continue;
      CHECK(line.find("`" + std::string(parameter.key) + "`") != std::string::npos);
    }
  }
}

TEST_CASE("an id that no effect has is refused, and the ids are those of the files") {
  CHECK_THROWS_AS(diagnose::effect_index("magic"), std::out_of_range);
  CHECK_THROWS_AS(diagnose::effect_of(""), std::out_of_range);
  for (const std::string& id : diagnose::effect_words()) {
    INFO(id);
    CHECK(diagnose::effect_of(id).id == id);
    int files = 0;
    for (const char* folder : {"force", "camera", "record"}) {
      files += fs::exists(fs::path(tests::kSourceDir) / "diagnose/effects" / folder / (id + ".cpp"));
    }
    CHECK(files == 1);
  }
  // smoothing_bias shows only in a table of lines.
  CHECK(diagnose::effect_list().size() + 1 == diagnose::all_effects().size());
}

TEST_CASE("effects are absent by default, and each that moves a glider or what is seen of it does so") {
  const std::vector<double> t = times();
  const diagnose::Moved nominal = diagnose::move(glider(), t);
  for (const diagnose::EffectInfo& effect : diagnose::all_effects()) {
    if (effect.parameters.empty() || effect.law.row_s != nullptr) continue;
    INFO(effect.id);
    diagnose::TrackModel model = glider();
    for (const auto& parameter : effect.parameters) model.effects[parameter.slot] = typical(parameter);
    const diagnose::Moved moved = diagnose::move(model, t);
    double most = 0.0;
    for (std::size_t p = 0; p < t.size(); ++p) most = std::max(most, std::abs(moved.x_m[p] - nominal.x_m[p]));
    CHECK(std::isfinite(moved.x_m.back()));
    CHECK(most > 1e-5);
  }
}

TEST_CASE(
    "the step of every parameter gives the derivative of the motion that four times finer and coarser ones give") {
  // A central difference errs by x''' h²/6 and by the rounding of x over h, about 1e-16/h. Fits need derivatives to a
  // thousandth of the largest.
  const std::vector<double> t = times();
  for (const diagnose::EffectInfo& effect : diagnose::all_effects()) {
    if (effect.parameters.empty() || effect.law.row_s != nullptr) continue;
    for (const diagnose::EffectParameter& parameter : effect.parameters) {
      INFO(effect.id << " " << parameter.key);
      diagnose::TrackModel model = glider();
      for (const auto& other : effect.parameters) model.effects[other.slot] = typical(other);
      const auto derivative = [&](double step) {
        const double kept = model.effects[parameter.slot];
        model.effects[parameter.slot] = kept + step;
        const std::vector<double> above = diagnose::move(model, t).x_m;
        model.effects[parameter.slot] = kept - step;
        const std::vector<double> below = diagnose::move(model, t).x_m;
        model.effects[parameter.slot] = kept;
        std::vector<double> slope;
        for (std::size_t p = 0; p < t.size(); ++p) slope.push_back((above[p] - below[p]) / (2.0 * step));
        return slope;
      };
      const std::vector<double> used = derivative(parameter.step);
      for (const double factor : {0.25, 4.0}) {
        const std::vector<double> other = derivative(factor * parameter.step);
        double most = 0.0, apart = 0.0;
        for (std::size_t p = 0; p < t.size(); ++p) {
          most = std::max(most, std::abs(used[p]));
          apart = std::max(apart, std::abs(used[p] - other[p]));
        }
        CHECK(most > 0.0);
        CHECK(apart < 1e-3 * most);
      }
    }
  }
}
