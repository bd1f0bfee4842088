#include "validate/blind/blind_score.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/files/file_io.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"
#include "validate/blind/case/blind_effects.h"
#include "validate/blind/run_blind.h"

using namespace glidelab;
namespace fs = std::filesystem;

namespace {

constexpr const char* kNothingFound =
    R"({"format": 1, "verdict": "none", "points": 1000, "effects": [], "probability": {"none": 0.9, "unknown": 0.1},
        "ranking": [], "where": {"regions": []}, "gap": null})";

validate::BlindOutcome left_out(const std::string& effect, diagnose::Verdict verdict,
                                const std::vector<std::string>& where = {}) {
  validate::BlindOutcome outcome;
  outcome.kind = validate::BlindKind::single;
  validate::BlindCause cause;
  cause.id = effect;
  outcome.causes = {cause};
  outcome.verdict.verdict = diagnose::Verdict::effect;
  outcome.verdict.effects = {{effect, 0.9, {"power_law_drag"}}};
  outcome.left_out.emplace();
  outcome.left_out->verdict = verdict;
  outcome.left_out->where = where;
  return outcome;
}

}  // namespace

TEST_CASE("of what is unknown without its effect the first region counts, where an effect has a variable") {
  std::vector<validate::BlindOutcome> outcomes = {left_out("track_bow", diagnose::Verdict::unknown, {"x_m", "v_m_s"}),
                                                  left_out("track_bow", diagnose::Verdict::unknown, {"v_m_s", "x_m"}),
                                                  left_out("track_bow", diagnose::Verdict::unknown),
                                                  left_out("late_release", diagnose::Verdict::unknown, {"clip"}),
                                                  left_out("scale_error", diagnose::Verdict::unknown, {"x_m"}),
                                                  left_out("track_bow", diagnose::Verdict::none)};
  const validate::BlindScore score = validate::score_blind(outcomes);
  CHECK(score.left_out_where.of == 4);
  CHECK(score.left_out_where.yes == 2);
  CHECK(score.left_out.at(validate::VerdictWithout::unknown).yes == 5);
  CHECK(score.left_out.at(validate::VerdictWithout::none).yes == 1);
}

TEST_CASE("a name in place of the effect is its equal, another, or a sure one") {
  validate::BlindOutcome outcome = left_out("quadratic_drag", diagnose::Verdict::effect);
  outcome.left_out->effects = {{"power_law_drag", 0.9, {}}};
  CHECK(validate::verdict_without(outcome) == validate::VerdictWithout::equivalent);
  outcome.left_out->effects = {{"tether", 0.6, {}}};
  CHECK(validate::verdict_without(outcome) == validate::VerdictWithout::other_name);
  outcome.left_out->effects = {{"tether", 0.9, {}}};
  CHECK(validate::verdict_without(outcome) == validate::VerdictWithout::sure_other_name);
  outcome.left_out.reset();
  CHECK_THROWS_AS(validate::verdict_without(outcome), std::logic_error);
}

TEST_CASE("only effects of the list have variables, and they are those of a diagnosis") {
  const std::vector<std::string> known = {"x_m", "v_m_s", "t_s", "a_m_s2", "mass_kg", "direction", "clip"};
  for (const std::string& id : validate::library_effects()) {
    for (const std::string& variable : validate::variables_of(id)) {
      CHECK(std::find(known.begin(), known.end(), variable) != known.end());
    }
  }
  CHECK(validate::variables_of("track_bow") == std::vector<std::string>{"x_m"});
  CHECK(validate::variables_of("scale_error").empty());
  CHECK(validate::variables_of("sagging_tripod").empty());
}

TEST_CASE("a case whose diagnosis without its effect failed counts as failed, and is not tried again") {
  tests::TempDir temp;
  std::size_t calls = 0;
  const validate::Diagnoser diagnoser = [&](const fs::path&, const fs::path& out,
                                            const std::vector<std::string>& without) -> std::string {
    ++calls;
    if (!without.empty()) return "made to fail";
    base::write_file(out / "diagnosis.json", kNothingFound);
    return "";
  };
  validate::BlindOptions options;
  options.cases = 1;
  options.only = "track_bow";
  options.leave_out = true;
  for (int run = 0; run < 2; ++run) {
    const auto outcomes = validate::run_blind(options, temp / "out", diagnoser);
    REQUIRE(outcomes.size() == 1);
    REQUIRE(outcomes[0].left_out.has_value());
    CHECK_FALSE(outcomes[0].left_out->verdict);
    CHECK(outcomes[0].left_out->why == "made to fail");
    CHECK(validate::score_blind(outcomes).left_out.at(validate::VerdictWithout::unknown).of == 1);
    CHECK(validate::score_blind(outcomes).left_out.at(validate::VerdictWithout::failed).yes == 1);
  }
  CHECK(calls == 2);
}
