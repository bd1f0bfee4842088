#include "report/diagnosis/words/cause_words.h"

#include "report/diagnosis/diagnosis_report.h"
#include "report/diagnosis/words/verdict_words.h"
#include "tests/catch.h"
#include "tests/report/made_diagnoses.h"

using namespace glidelab;

namespace {

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("a share has whole percents, tenths near its ends, and its interval") {
  CHECK(report::share_text(0.914) == "91 %");
  CHECK(report::share_text(0.91, diagnose::GapInterval{0.86, 0.95}) == "91 % (86 to 95 %)");
  CHECK(report::share_text(0.997, diagnose::GapInterval{0.98, 1.004}) == "99.7 % (98.0 to 100.0 %)");
  CHECK(report::share_text(0.003) == "0.3 %");
  CHECK(report::share_text(-0.02) == "-2.0 %");
  CHECK(report::share_text(0.0) == "0 %");
  CHECK(report::share_text(-2e-4) == "0 %");
  CHECK(report::share_text(-2e-4, diagnose::GapInterval{-0.02, 0.02}) == "0.0 % (-2.0 to 2.0 %)");
  CHECK(report::share_text(1.0) == "100 %");
  CHECK(report::share_text(0.99996, diagnose::GapInterval{0.9998, 1.0001}) == "over 99.9 %");
  CHECK(report::share_text(0.99996, diagnose::GapInterval{0.998, 1.002}) == "100.0 % (99.8 to 100.0 %)");
}

TEST_CASE("the answer says how much each cause explains, with its size, and what is left") {
  const diagnose::Diagnosis of = tests::two_causes();
  // The gap that is left: g² = 1 + 0.03 (5.3² - 1) = 1.8127, g = 1.346.
  const std::string answer =
      "Quadratic drag, c = 0.00310 ± 0.00020 kg/m, explains 91 % (86 to 95 %) of the gap on clips that were held out; "
      "added inertia, mass = 0.0123 ± 0.0014 kg, explains another 6 % (2 to 10 %); 3 % remains, 1.35 times "
      "the noise.";
  CHECK(report::sequence_words(of) == answer);
  const std::string words = report::verdict_words(of);
  CHECK(words.starts_with(answer + " Probability: quadratic drag 97 %, added inertia 81 %."));
  CHECK(says(words, "Held-out clips lie 5.30 times as far from the nominal model"));
  CHECK_FALSE(says(words, "with these effects in the model"));  // what is left is told once
  CHECK(says(report::diagnosis_meaning(of), "<p><b>Quadratic drag"));
}

TEST_CASE("beside a cause that takes all but a trifle, another is told by what it leaves") {
  diagnose::Diagnosis of = tests::two_causes();
  of.explained[0].share = 0.999;
  of.explained[0].gap_after = 19.3;
  of.explained[1].share = 3e-4;
  of.explained[1].share_interval95 = diagnose::GapInterval{-1e-4, 4e-4};
  of.explained[1].gap_after = 15.6;
  CHECK(says(report::sequence_words(of),
             "; added inertia, mass = 0.0123 ± 0.0014 kg, reduces what is left from 19.3 to 15.6 times the "
             "noise; "));
  CHECK(report::share_text(3e-4, of.explained[1].share_interval95) == "less than 0.1 %");
  of.explained[1].gap_after = 20.0;  // not less
  CHECK(says(report::sequence_words(of), "explains another less than 0.1 %"));
}

TEST_CASE("a remainder that is a trifle of a large gap is not called nothing while it stands above the noise") {
  diagnose::Diagnosis of = tests::two_causes();
  of.remainder->share = 2e-4;
  of.remainder->gap = 9.59;
  CHECK(says(report::sequence_words(of), "; less than 0.1 % remains, 9.59 times the noise."));
  of.remainder->gap = 1.04;
  CHECK(says(report::sequence_words(of), "; nothing is left above the noise."));
}

TEST_CASE("a cause is told without what was not fitted, of each set-up by itself, or not found") {
  diagnose::Diagnosis of = tests::two_causes();
  of.effects.front().parameters = {{"x_mid_m", 0.4, 0.0},
                                   {"x_mid_m.slope", 0.4, 0.01},
                                   {"n", 0.0, 0.0, "", core::WhyUnknown{core::unknown::Told{"no speeds"}}}};
  CHECK(report::sequence_words(of).starts_with("Quadratic drag explains 91 %"));
  of.remainder.reset();
  CHECK(report::sequence_words(of).ends_with("explains another 6 % (2 to 10 %)."));
  of.remainder = diagnose::GapRemainder{-0.001, 0.99, 0.0, 0.0, 0.0, {}};
  CHECK(report::sequence_words(of).ends_with("; nothing is left above the noise."));
}

TEST_CASE("a drag of air is contradicted in the answer where a viscous drag alone would leave clearly less") {
  diagnose::Diagnosis of = tests::two_causes();
  const auto with_gap = [&](double viscous) {
    of.notes = {diagnose::FallsThroughAir{{}, {{viscous, 11.2}}}};
    return report::sequence_words(of);
  };
  CHECK(says(with_gap(4.85), " A viscous drag alone would leave less, 4.85 times the noise, though air does not"));
  CHECK_FALSE(says(with_gap(10.5), "viscous"));  // within a tenth of what is named
  CHECK_FALSE(says(with_gap(20.0), "viscous"));
  of.notes = {diagnose::FallsThroughAir{}};
  CHECK_FALSE(says(report::sequence_words(of), "viscous"));
}

TEST_CASE("a cause that leaves less than the noise explains all of the gap, not more than that") {
  diagnose::Diagnosis of = tests::two_causes();
  of.explained.resize(1);
  of.explained.front().share = 1.126;
  of.explained.front().share_interval95.reset();
  of.remainder = diagnose::GapRemainder{-0.126, 0.93, 0.0, 0.0, 0.0, {}};
  CHECK(says(report::sequence_words(of), "explains all of the gap on clips that were held out; nothing is left"));
}

TEST_CASE("the verb follows the name of the cause: several frame times explain, one drag explains") {
  diagnose::Diagnosis of = tests::two_causes();
  const auto begins = [&](const char* id, const char* words) {
    of.explained.front().id = id;
    INFO(report::sequence_words(of));
    return report::sequence_words(of).starts_with(words);
  };
  CHECK(begins("timestamp_jitter", "Uneven frame times explain 91 %"));
  CHECK(begins("heavy_tailed_noise", "Outliers explain 91 %"));
  CHECK(begins("rotational_inertia", "Added inertia, mass = 0.0123 ± 0.0014 kg, explains 91 %"));
  CHECK(begins("late_release", "Late release explains 91 %"));
  CHECK(begins("damping_gradient", "Drag that varies along x explains 91 %"));
  CHECK(begins("stribeck", "More friction at low speed explains 91 %"));
  CHECK(begins("smoothing_bias", "Smoothing bias explains 91 %"));
}

TEST_CASE("causes that look alike, and effects that have no share, are told behind the answer") {
  diagnose::Diagnosis of = tests::two_causes();
  of.effects.front().joint_probability = 0.98;
  of.effects.front().alike = {{"quadratic_drag", "", 0.68}, {"power_law_drag", "", 0.30}, {"eddy_rolloff", "", {}}};
  of.explained.pop_back();
  CHECK(report::sureness_words(of) ==
        "These data cannot tell quadratic drag (68 %), power-law drag (30 %) and magnetic drag that falls off apart; "
        "one of them acts with a probability of 98 %. Also likely: added inertia 81 %. Added inertia "
        "contributes nothing to this gap.");
  of.effects.front().alike[1].probability = 0.03;  // less than a twentieth of 0.68
  CHECK(report::sureness_words(of).starts_with(
      "These data cannot tell quadratic drag (68 %) and magnetic drag that falls off apart; one of them acts"));
  of.effects.front().alike.pop_back();
  CHECK(report::sureness_words(of).starts_with("Probability: quadratic drag "));
  of.effects.back().by_stated = true;
  CHECK(report::sureness_words(of).ends_with(
      " Added inertia shows only in the stated inclination, which the motion contradicts without it."));
}

TEST_CASE("traces are no part of the verdict: nothing that matters is missing, whatever is likeliest") {
  const diagnose::Diagnosis of = tests::traces_alone();
  CHECK(report::sequence_words(of) ==
        "Nothing that matters is missing. Also detected, with no effect on K/m, µ or α: uneven frame times.");
  CHECK(report::verdict_words(of).starts_with("Nothing that matters is missing."));
  CHECK_FALSE(says(report::verdict_words(of), "It is uncertain"));
  diagnose::Diagnosis one = of;
  one.traces = {"rolling_shutter"};
  CHECK(says(report::sequence_words(one), "with no effect on K/m, µ or α: rolling shutter."));
  one.traces.clear();
  CHECK(report::sequence_words(one).empty());
}

TEST_CASE("where no cause takes half, the answer says so, what helps, and where the rest lies") {
  diagnose::Diagnosis of = tests::no_half();
  // g² = 1 + 0.69 (5.3² - 1) = 19.69, g = 4.44.
  CHECK(report::verdict_words(of).starts_with(
      "Something is missing, and no known effect is likely to explain half of the held-out gap: uneven frame times "
      "explain 31 % (20 to 42 %); 69 % remains, 4.44 times the noise. What is left is clearest at times from 0 to "
      "0.1 s after the start of clip m2-up: force of up to 1.20 ± 0.10 mN after 50 ms."));
  of.explained.clear();
  of.remainder->share = 1.0;
  of.remainder->gap = 5.3;
  of.ranking.clear();
  CHECK(says(report::verdict_words(of),
             "None reduces it by more than its uncertainty: it is 5.3 times the noise. What is left is clearest"));
  of.remainder->regions.front().lacking = 1e-5;  // far less than the size that was found
  CHECK(says(report::verdict_words(of), "force. Its size cannot be determined from these data."));
}

TEST_CASE("where nothing is likely enough to be named, the likeliest that would take half of the gap are told") {
  diagnose::Diagnosis of = tests::no_half();
  of.explained.clear();
  of.remainder->share = 1.0;
  of.remainder->gap = 5.3;
  const auto one = [](std::vector<std::string> effects, double probability, double gap_after) {
    diagnose::RankedExplanation ranked;
    ranked.explanation.effects = std::move(effects);
    ranked.probability = probability;
    ranked.gap_after = gap_after;
    return ranked;
  };
  // Half of the excess is left at a gap of 3.81: g² = 1 + 0.5 (5.3² - 1).
  of.ranking = {one({"clip_scatter"}, 0.26, 1.27), one({"tether"}, 0.2, 3.9),
                one({"friction_drift", "place_friction"}, 0.1, 2.74), one({"end_stop"}, 0.04, 1.1)};
  CHECK(report::verdict_words(of).starts_with(
      "Something is missing, and no known effect is likely enough to be named. Likeliest: scatter from clip to clip "
      "(26 "
      "%), with which the gap would be 1.27 in place of 5.3 times the noise; drifting friction and friction that "
      "varies "
      "along x (10 %), with which the gap would be 2.74. What is left is clearest"));
  of.ranking = {one({"tether"}, 0.4, 3.9)};
  CHECK(says(report::verdict_words(of), "None reduces it by more than its uncertainty"));
}

TEST_CASE("a law that holds within each configuration and not across them is told first, with what differs") {
  const diagnose::Diagnosis of = tests::law_within();
  CHECK(report::sequence_words(of).starts_with(
      "The law holds within each configuration (gap 1.02); across them it does not (5.3)."));
  diagnose::Diagnosis worse = of;
  worse.levels->configuration = 2.1;
  CHECK(report::sequence_words(worse).starts_with(
      "The law fits far better within each configuration (gap 2.1) than across them (5.3)."));
  const auto rows = report::member_rows(of.effects.front());
  REQUIRE(rows.size() == 3);
  CHECK(rows[0] == std::vector<std::string>{"", "µ"});
  CHECK(rows[1] == std::vector<std::string>{"0.335 kg, 4°", "0.00710 ± 0.00010"});
  CHECK(rows[2] == std::vector<std::string>{"0.435 kg, 4°", "0.00830 ± 0.00010"});
  CHECK(report::member_rows(tests::two_causes().effects.front()).empty());
  const std::string page = report::diagnosis_report("within", of).html;
  CHECK(says(page, "<h2>What differs</h2>"));
  CHECK(says(page, "kg, 4°</td><td class=\"n\">0.00830\u00a0±\u00a00.00010</td>"));
}

TEST_CASE("the gap at each level is one sentence, whichever levels there are") {
  diagnose::Diagnosis of;
  CHECK(report::levels_words(of).empty());
  of.levels = diagnose::GapLevels{};
  of.levels->all = 5.3;
  CHECK(report::levels_words(of).empty());
  of.levels->configuration = 2.5;
  CHECK(report::levels_words(of) ==
        "With no clip held out: fitted to each configuration separately, the nominal model has a gap of 2.5; to all "
        "clips, 5.3 (1 is the "
        "noise).");
  of.levels->clip = 1.1;
  CHECK(report::levels_words(of) ==
        "With no clip held out: fitted to each clip separately, the nominal model has a gap of 1.1; to each "
        "configuration, 2.5; to all clips, "
        "5.3 (1 is the noise).");
}

TEST_CASE("what is left is told as an acceleration and a scatter, with their units") {
  diagnose::GapRemainder of = *tests::two_causes().remainder;
  CHECK(report::remainder_words(of) ==
        "The remainder corresponds to a random acceleration of 4.1 mm/s² (rms) along the track. From clip to clip, "
        "friction and inclination scatter by 0.8 mm/s² and the drag by 2.1 %.");
  of.clip_scatter_m_s2 = 0.0;
  CHECK(report::remainder_words(of).ends_with("From clip to clip, the drag scatters by 2.1 %."));
  of.clip_scatter_m_s2 = 2.4e-8;  // a trace of the search
  CHECK(report::remainder_words(of).ends_with("From clip to clip, the drag scatters by 2.1 %."));
  of.drag_scatter = 4e-5;
  CHECK(report::remainder_words(of).find("From clip to clip") == std::string::npos);
  of.acceleration_m_s2 = of.drag_scatter = 0.0;
  CHECK(report::remainder_words(of).empty());
  diagnose::GapRegion region{diagnose::GapVariable::mass,     0.335, 0.335, 4.0, 0.01, "m/s²",
                             diagnose::GapKind::acceleration, ""};
  CHECK(report::region_words(region) == "with 0.335 kg");
  region.variable = diagnose::GapVariable::position;
  region.to = 0.5;
  region.clip = "m1-up";
  CHECK(report::region_words(region) == "at positions from 0.335 to 0.5 m of clip m1-up");
}

TEST_CASE("recovered quantities stand under the causes that are in their model, with why one is undetermined") {
  diagnose::Diagnosis of = tests::two_causes();
  auto tables = report::recovered_tables(of);
  REQUIRE(tables.size() == 1);
  CHECK(report::with_words(tables[0].with) == "with quadratic drag and added inertia in the model");
  REQUIRE(tables[0].rows.size() == 3);
  CHECK(tables[0].rows[1][0] == "0.335 kg, 4°");
  CHECK(tables[0].rows[1][1] == "2.7463 ± 0.0060");  // 0.92/0.335
  CHECK(tables[0].rows[2][4] == "–");
  CHECK(tables[0].why ==
        std::vector<std::string>{"terminal velocity of 0.435 kg, 4°: the clips hold no motion downhill"});
  of.recovered.back().group = "other";
  of.recovered.back().with.clear();
  tables = report::recovered_tables(of);
  REQUIRE(tables.size() == 2);
  CHECK(tables[0].rows[1][0] == "0.335 kg, 4°, slope");
  CHECK(report::with_words(tables[1].with) == "by the nominal model");
  for (diagnose::RecoveredConfiguration& one : of.recovered) {
    if (one.group == "slope") one.is_named_by_incline = true;  // "4 deg", which the label has already
  }
  CHECK(report::recovered_tables(of)[0].rows[1][0] == "0.335 kg, 4°");
}

TEST_CASE("a reason that several configurations share is told once") {
  diagnose::Diagnosis of;
  for (const double mass_kg : {0.001, 0.002, 0.003}) {
    diagnose::RecoveredConfiguration one;
    one.group = "fall";
    one.mass_kg = mass_kg;
    one.incline_deg = 90.0;
    one.mu = {.estimate = {}, .why = core::WhyUnknown{core::unknown::Told{"a fall has no normal force"}}};
    if (mass_kg < 0.0025) one.v_lim_m_s = {.estimate = {}, .why = core::WhyUnknown{core::unknown::Told{"too short"}}};
    of.recovered.push_back(one);
  }
  const auto tables = report::recovered_tables(of);
  REQUIRE(tables.size() == 1);
  CHECK(tables[0].why == std::vector<std::string>{"µ of all: a fall has no normal force",
                                                  "terminal velocity of 0.001 kg, 90°; 0.002 kg, 90°: too short"});
}

TEST_CASE("a terminal has the answer, the causes, what is left, the quantities and the next step before the ranking") {
  const std::string text = report::diagnosis_text(tests::two_causes());
  CHECK(text.starts_with("Quadratic drag, c ="));
  std::size_t at = 0;
  for (const char* part :
       {"\nverdict: effect\n", "\nquadratic drag (quadratic_drag)     91 % (86 to 95 %)       1.85\n", "\nremainder ",
        "random acceleration", "It is clearest at times", "in the model:\n", "\n0.335 kg, 4°", "\nnext: Repeat",
        "\nprobability  explanation\n", "\ngap of held-out clips: 5.300 before"}) {
    INFO(part << "\n" << text);
    const std::size_t found = text.find(part, at);
    REQUIRE(found != std::string::npos);
    at = found;
  }
  CHECK(text.find("next: ") == text.rfind("next: "));
  // What all rows share, and what only files and options need, is elsewhere.
  CHECK(text.find("log evidence") == std::string::npos);
  CHECK(text.find("quadratic_drag") == text.rfind("quadratic_drag"));
}
