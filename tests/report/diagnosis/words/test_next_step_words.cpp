/// Next steps of a diagnosis as sentences.
#include "report/diagnosis/words/next_step_words.h"

#include <string>

#include "report/diagnosis/words/diagnosis_words.h"
#include "tests/catch.h"

using namespace glidelab;

namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

diagnose::Change launch(diagnose::ChangeKind kind, double v_m_s, double mass_kg) {
  diagnose::Change change;
  change.kind = kind;
  change.clip = diagnose::NextClip{0, mass_kg, v_m_s, 100.0};
  change.downhill = 1;
  change.rate_so_far_hz = 100.0;
  return change;
}

std::string words_for(const diagnose::Change& change) {
  return report::next_step_words(diagnose::SettleDoubt{{{{{"tether"}}, {}}}, change, {62, {change.kind}}, 7.25});
}

}  // namespace

TEST_CASE("a change is an order with its numbers in units that people use") {
  using diagnose::ChangeKind;
  CHECK(words_for(launch(ChangeKind::launch, -1.2, 0.535))
            .starts_with("Record a launch uphill at 1.2 m/s with 535 g: of the 62"));
  diagnose::Change heavy = launch(ChangeKind::launch, 0.3, 95.109);
  CHECK(contains(words_for(heavy), "with 95.1 kg"));
  heavy.falls = true;
  CHECK(words_for(heavy).starts_with("Record a fall with 95.1 kg"));
  diagnose::Change other = launch(ChangeKind::mass, 2.16, 0.856);
  other.on = "flat";
  CHECK(words_for(other).starts_with(
      "Record a launch downhill at 2.2 m/s on set-up \"flat\" with the mass changed to 856 g:"));
  // 1 kg stands for a mass that nobody states.
  diagnose::Change lighter = launch(ChangeKind::mass, 0.1, 0.6);
  lighter.falls = lighter.mass_assumed = true;
  CHECK(words_for(lighter).starts_with("Record a fall with 0.6 times the mass: of"));
  lighter.kind = ChangeKind::launch;
  lighter.clip->mass_kg = 1.0;
  CHECK(words_for(lighter).starts_with("Record a fall with the same mass: of"));
  CHECK(report::next_step_words(diagnose::AddMass{1.6, true}).starts_with("Record 1.6 times the mass both ways"));
  diagnose::Change tilted = launch(ChangeKind::inclination, 1.2, 0.5);
  tilted.set_up = diagnose::NextSetUp{0.10472, 0.0};
  CHECK(words_for(tilted).starts_with("Tilt the track to 6.0° and record a launch downhill at 1.2 m/s with 500 g: of"));
  tilted.set_up->alpha_rad = 0.0;
  tilted.downhill = 0;
  CHECK(words_for(tilted).starts_with(
      "Make the track level and record a launch towards larger x at 1.2 m/s with 500 g: of"));
  diagnose::Change rate = launch(ChangeKind::frame_rate, 1.2, 0.5);
  rate.clip->rate_hz = 200.0;
  CHECK(contains(words_for(rate), "at 200 frames per second instead of 100"));
  CHECK(contains(words_for(launch(ChangeKind::exposure, 1.2, 0.5)), "half the exposure"));
  diagnose::Change statement;
  statement.rate_so_far_hz = 100.0;
  statement.kind = ChangeKind::plumb;
  statement.statements = {{diagnose::NextStatement::Of::inclination, 0, 0.0, 0.0, 0.05 * 0.017453292519943295}};
  CHECK(contains(words_for(statement), "Film a plumb line (it gives the inclination to 0.05°)"));
  statement.kind = ChangeKind::pattern;
  statement.statements = {{diagnose::NextStatement::Of::length, 0, -0.6, 0.0, 5e-4}};
  CHECK(contains(words_for(statement), "(0.5 mm in 0.6 m)"));
  statement.kind = ChangeKind::clock;
  statement.statements = {{diagnose::NextStatement::Of::clock, 0, 0.0, 0.0, 1e-3}};
  CHECK(contains(words_for(statement), "Film a running stopwatch for 10 s"));
}

TEST_CASE("a doubt is told as what each explanation has and the other lacks, each name once") {
  diagnose::SettleDoubt step;
  step.doubt = {{{{"scale_error"}}, {{"direction_asymmetry"}}},
                {{{"scale_error"}}, {{"frame_rate_error"}}},
                {{{"stribeck"}}, {}}};
  step.weighed = {62, {diagnose::ChangeKind::launch, diagnose::ChangeKind::plumb}};
  step.log_likelihood = 1.234;
  const auto name = [](const char* id) { return report::explanation_name({{id}}); };
  CHECK(name("stribeck") != "stribeck");  // people read names, not ids
  CHECK(report::next_step_words(step).starts_with(
      "None of the 62 changes considered (launches, a view of a plumb line) would decide whether it is " +
      name("scale_error") + " rather than " + name("direction_asymmetry") + " or " + name("frame_rate_error") +
      ", and whether “" + name("stribeck") + "” acts (expected gain in log likelihood at most 1.2)"));
  CHECK(report::next_step_words(diagnose::RecordForEffect{"Film it again.", step.doubt.back()}) ==
        "It is uncertain whether “" + name("stribeck") + "” acts. Film it again.");
  CHECK(report::next_step_words(diagnose::RecordForEffect{"Film it again.", {}}) == "Film it again.");
}

TEST_CASE("where x rises uphill or the track is level, a launch goes that way and not uphill or downhill by its sign") {
  diagnose::Change change = launch(diagnose::ChangeKind::launch, -1.2, 0.5);
  change.downhill = -1;
  CHECK(words_for(change).starts_with("Record a launch downhill at 1.2 m/s"));
  change.downhill = 0;
  CHECK(words_for(change).starts_with("Record a launch towards smaller x at 1.2 m/s"));
  change.clip->v0_m_s = 1.2;
  CHECK(words_for(change).starts_with("Record a launch towards larger x at 1.2 m/s"));
  change.clip->v0_m_s = -4e-12;  // nobody launches at that speed
  CHECK(words_for(change).starts_with("Record a release from rest"));
}

TEST_CASE("each explanation in doubt has one clause, with all that may be in its place") {
  const auto name = [](const char* id) { return report::explanation_name({{id}}); };
  diagnose::SettleDoubt step;
  step.doubt = {{{{"lens_distortion"}}, {{"configuration_drag"}}},
                {{{"lens_distortion"}}, {{"base_vibration"}}},
                {{{"lens_distortion"}}, {{"stribeck", "configuration_drag"}}}};
  step.log_likelihood = 1.0;
  CHECK(contains(report::next_step_words(step), "would decide whether it is " + name("lens_distortion") +
                                                    " rather than " + name("configuration_drag") + ", " +
                                                    name("base_vibration") + ", or " + name("stribeck") +
                                                    " together with " + name("configuration_drag") + " (expected"));
}

TEST_CASE("no less noise and no more clips are asked for where the motion is the same under both explanations") {
  diagnose::SettleDoubt step;
  step.doubt = {{{{"end_stop"}}, {{"tether"}}}};
  step.log_likelihood = 3.3e-13;  // 5 would take 10^13 clips
  const std::string same = report::next_step_words(step);
  CHECK_FALSE(contains(same, "less noise"));
  CHECK_FALSE(contains(same, "many more clips"));
  CHECK(contains(same, "the motion is the same either way. Check directly for what is in doubt"));
  step.log_likelihood = 0.5;  // ten such clips would do
  CHECK(
      contains(report::next_step_words(step), "less noise (a longer lens, a larger marker) or many more clips would."));
}

TEST_CASE("the least well known parameter is named with its size, of the nominal model by its letter") {
  diagnose::SharpenParameter step{"c_kg_m", "quadratic_drag", 0.1, 0.01, {}, {62, {}}, 0.0};
  const std::string drag = report::explanation_name({{"quadratic_drag"}});
  const std::string least = " The least well known parameter is c of " + drag + " (0.100 ± 0.010 kg/m). None of ";
  CHECK(report::next_step_words(step).starts_with("No other explanation is likely." + least + "the 62"));
  step.undecided = {{{{"end_stop"}}, {}}};
  CHECK(report::next_step_words(step).starts_with("None of the 62 changes considered () would decide whether “" +
                                                  report::explanation_name({{"end_stop"}}) + "” acts." + least +
                                                  "these"));
  step = {"K", "", 0.93, 0.01, launch(diagnose::ChangeKind::launch, 1.0, 0.3), {62, {}}, 0.005, true};
  const std::string words = report::next_step_words(step);
  CHECK(contains(words, "The least well known parameter is K (0.930 ± 0.010 N s/m). Record a launch"));
  CHECK(contains(words, "a second mass would separate them"));
}

TEST_CASE("a step without numbers has a sentence with its reason, and no step has none") {
  using diagnose::Routine;
  CHECK(report::next_step_words({}).empty());
  for (const Routine routine :
       {Routine::repeat_each_kind, Routine::repeat_launch, Routine::start_later, Routine::turn_glider,
        Routine::set_up_again, Routine::move_camera, Routine::other_speeds, Routine::other_forces,
        Routine::measure_inclination, Routine::check_statements, Routine::second_mass}) {
    const std::string words = report::next_step_words(routine);
    CHECK(contains(words, ":"));
    CHECK(words.ends_with("."));
  }
  diagnose::CoverRegion cover;
  cover.launch = launch(diagnose::ChangeKind::launch, 2.16, 0.335);
  cover.from = 1.5;
  cover.to = 2.1;
  cover.launches = 12;
  cover.inside = 30;
  cover.positions = 80;
  CHECK(
      contains(report::next_step_words(cover), "it has the most positions (30 of 80) at positions from 1.5 to 2.1 m"));
  cover.over = diagnose::CoverRegion::Over::speeds;
  CHECK(contains(report::next_step_words(cover), "at speeds from 1.5 to 2.1 m/s"));
  CHECK(contains(report::next_step_words(diagnose::AddMass{0.435}), " 435 g "));
  CHECK(contains(report::next_step_words(diagnose::RepeatClip{"up_2"}), "clip up_2 three times"));
  CHECK(contains(report::next_step_words(diagnose::TellLinesApart{1.6, 0.024, 0.015, 0.001}), "1600 g"));
}
