#include "report/requirement/requirement_words.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "report/requirement/requirement_plot.h"
#include "report/requirement/requirement_report.h"
#include "tests/catch.h"

using namespace glidelab;
using Catch::Matchers::Contains;

namespace {

validate::Candidate camera(const std::string& name, double price, validate::Verdict verdict, double error) {
  validate::Candidate of;
  of.name = name;
  of.price = price;
  of.price_class = "8-25 EUR";
  of.frame_rate_hz = 90.0;
  of.noise_m = 1.5e-5;
  of.mode = {640, 480, 0.002, {validate::CodecSetting::Kind::h264_bitrate, 8000.0}};
  of.verdict = verdict;
  of.judged_by = validate::Confirm::clips;
  of.results = {{1e-5, error, 0.1 * error, 20, 0, "trajectory", 0.8 * error, 1.3 * error}};
  return of;
}

validate::Requirement cameras() {
  validate::Requirement requirement;
  requirement.name = "cameras";
  requirement.by_price = true;
  requirement.confirm = validate::Confirm::clips;
  requirement.runs = 20;
  requirement.targets = {{"mu", validate::Target::Measure::error95, 1e-4}};
  requirement.candidates = {camera("webcam, 640x480 at 30 fps", 12.0, validate::Verdict::missed, 4e-4),
                            camera("board (OV5647), 640x480 at 90 fps", 16.0, validate::Verdict::reached, 6e-5),
                            camera("phone", 400.0, validate::Verdict::reached, 1e-5)};
  return requirement;
}

}  // namespace

TEST_CASE("every verdict on a camera has words, with what it rests on") {
  using validate::Confirm;
  using validate::Verdict;
  const auto words = [](Verdict verdict, Confirm by) {
    validate::Candidate candidate;
    candidate.verdict = verdict;
    candidate.judged_by = by;
    return report::candidate_verdict(candidate);
  };
  CHECK(words(Verdict::reached, Confirm::clips) == "reached, by clips");
  CHECK(words(Verdict::reached, Confirm::tracks) == "reached, by tracks");
  CHECK(words(Verdict::by_bound, Confirm::none) == "reached: the bound is well below the target");
  CHECK(words(Verdict::unconfirmed, Confirm::none) == "possible, not run");
  CHECK(words(Verdict::undecided, Confirm::clips) == "undecided, by clips");
  CHECK(words(Verdict::missed, Confirm::tracks) == "missed, by tracks");
  CHECK(words(Verdict::impossible, Confirm::none) == "impossible");
  CHECK(words(Verdict::refused, Confirm::none) == "refused");
}

TEST_CASE("every limitation of a camera says what the camera would have instead, and whether runs have shown it") {
  using validate::Limitation;
  const std::vector<std::pair<Limitation, std::string>> all = {
      {Limitation::frame_rate, "frame rate (1000 Hz, same exposure)"},
      {Limitation::light, "light (no shot noise)"},
      {Limitation::camera_noise, "the camera's own noise (without it)"},
      {Limitation::motion_blur, "motion blur (without it)"},
      {Limitation::resolution, "resolution (4 times finer)"},
      {Limitation::clock, "clock (no lost frames, even frame times; by runs)"},
      {Limitation::rolling_shutter, "rolling shutter (global; by runs)"},
      {Limitation::codec, "codec (lossless; by runs)"},
      {Limitation::calibration, "calibration (the true camera; by runs)"},
      {Limitation::imaging, "lens, calibration and tracking (true positions with the expected noise, by runs)"}};
  CHECK(all.size() == static_cast<std::size_t>(Limitation::imaging) + 1);
  for (const auto& [limitation, words] : all) CHECK(report::limitation_words(limitation) == words);
}

TEST_CASE("a codec is said as it is set, and a target with its measure") {
  using Kind = validate::CodecSetting::Kind;
  CHECK(report::codec_words({}) == "frames without loss");
  CHECK(report::codec_words({Kind::mjpeg, 70.0}) == "MJPEG of quality 70");
  CHECK(report::codec_words({Kind::h264_quality, 23.0}) == "H.264 at crf 23");
  CHECK(report::codec_words({Kind::h264_bitrate, 12345.0}) == "H.264 at 12.3 Mbit/s");
  using Measure = validate::Target::Measure;
  CHECK(report::target_words({"mu", Measure::error95, 0.0005}) == "mu 95 % error 0.0005");
  CHECK(report::target_words({"k_over_m_1_s", Measure::sd, 0.01}) == "k_over_m_1_s sd 0.01");
  CHECK(report::target_words({"alpha_deg", Measure::bias, 0.1}) == "alpha_deg bias 0.1");
}

TEST_CASE("the first line of require says what to buy, how to set it and what to expect, on screen and page") {
  const std::string line =
      "Buy: board (OV5647), 8-25 EUR; set it to 640 x 480 pixels, 90 frames/s, exposure 2 ms, H.264 at 8 Mbit/s. "
      "Expect µ within 0.00006 (upper limit 0.000078): 95 % of 20 rendered experiments, analysed with the fit of the "
      "whole motion. The target was µ within 0.0001. Prices are rough, and exclude the computer.";
  CHECK(report::requirement_answer(cameras()) == line);
  CHECK(report::requirement_text(cameras()).starts_with(line + "\n"));
  CHECK(report::enough_words(cameras()).empty());
  CHECK_THAT(report::requirement_json(cameras()), Contains("\"answer\": \"Buy: board (OV5647)"));
  const std::string html = report::requirement_report(cameras()).html;
  CHECK(html.find("Which camera measures µ to 0.0001?") < html.find("Buy: board (OV5647)"));
  CHECK(html.find("Buy: board (OV5647)") < html.find("<figure"));
}

TEST_CASE("the question of require names the quantities, with their units and any other measure than a 95 % error") {
  validate::Requirement requirement = cameras();
  using Measure = validate::Target::Measure;
  requirement.targets = {{"k_over_m_1_s", Measure::error95, 0.01}, {"mu", Measure::error95, 0.0005}};
  CHECK(report::requirement_question(requirement) == "Which camera measures K/m to 0.01 1/s and µ to 0.0005?");
  requirement.targets = {{"alpha_deg", Measure::sd, 0.01}, {"mu", Measure::bias, 0.001}};
  CHECK(report::requirement_question(requirement) == "Which camera measures α to 0.01° (rms) and µ to 0.001 (bias)?");
}

TEST_CASE("a camera at hand, which costs nothing, is in the plot of require, where its line begins") {
  validate::Requirement requirement = cameras();
  requirement.candidates[0].price = 0.0;
  requirement.candidates[0].verdict = validate::Verdict::reached;
  const report::Plot plot = report::requirement_plot(requirement);
  const auto block = [&](const std::string& name) {
    return std::ranges::find(plot.drawing.data, name, &report::PlotData::name)->rows;
  };
  CHECK(block("met").front()[0] == 0.0);
  CHECK(block("front").front()[0] == 0.0);
  CHECK_THAT(plot.drawing.script, Contains("set nonlinear x") && Contains("'0' 0,") && !Contains("set logscale x"));
  const report::Page page = report::requirement_report(requirement);
  const std::string& drawn = page.files.at("plots/01-accuracy-reached-against-cost.svg");
  CHECK_THAT(drawn, Contains("<text>0</text>") && Contains("<text>10</text>"));
  requirement.candidates[0].price = 12.0;
  CHECK_THAT(report::requirement_plot(requirement).drawing.script,
             Contains("set logscale x") && !Contains("set nonlinear x"));
  for (validate::Candidate& candidate : requirement.candidates) candidate.price = 0.0;  // nothing to divide by
  CHECK(report::requirement_report(requirement).files.contains("plots/01-accuracy-reached-against-cost.svg"));
}

TEST_CASE("an estimator that judges every camera is named once, otherwise beside each camera") {
  validate::Requirement requirement = cameras();
  const std::string once = "All were judged with the fit of the whole motion.";
  CHECK_THAT(report::requirement_text(requirement), Contains(once) && !Contains("judged by  "));
  CHECK_THAT(report::requirement_report(requirement).html, Contains(once) && !Contains(">judged by</th>"));
  requirement.candidates[2].results[0].estimator = "phase-diagram";
  CHECK_THAT(report::requirement_text(requirement), !Contains(once) && Contains("judged by  "));
  CHECK_THAT(report::requirement_report(requirement).html, !Contains(once) && Contains(">judged by</th>"));
  for (validate::Candidate& candidate : requirement.candidates) candidate.results[0].estimator.clear();
  CHECK_THAT(report::requirement_text(requirement), !Contains("judged with") && !Contains("judged by"));
}

TEST_CASE("the table of cameras fits a terminal, with the beginnings of long names where these differ") {
  validate::Requirement requirement = cameras();
  requirement.candidates[0].name = "Industrial camera with IMX273, 1440x1080 at 227 fps (Basler class)";
  requirement.candidates[1].name = "Raspberry Pi camera v1 (OV5647), 640x480 at 90 fps";
  requirement.candidates[2].name = "Raspberry Pi Global Shutter camera, 1456x1088 at 60 fps";
  requirement.candidates[2].price_class = "75-110 EUR with lens";
  const std::string text = report::requirement_text(requirement);
  const std::string table = text.substr(text.find("\ncamera "));
  CHECK_THAT(table, Contains("\nIndustrial camera with IMX273…  ") && Contains("\nRaspberry Pi camera v1…  ") &&
                        Contains("\nRaspberry Pi Global Shutter…  ") && Contains("  75-110 EUR…  "));
  CHECK(table.find("\n\n") > table.find("Global Shutter"));  // in one part
  requirement.candidates[1].name = "Industrial camera with IMX273, 720x540 at 400 fps";
  CHECK_THAT(report::requirement_text(requirement), Contains("IMX273, 720x540 at 400 fps"));
}

TEST_CASE("what is much better than needed is said to be so, with what would do") {
  validate::Requirement requirement = cameras();
  requirement.candidates[1].enough = validate::Enough{50.0, 11.25, 2.4e-4};
  CHECK(report::enough_words(requirement) ==
        "This is 50 times better than needed: 11 frames/s, or a position noise of 0.24 mm in place of 15 µm would do.");
  requirement.candidates[1].enough = validate::Enough{4.0, {}, {}};
  CHECK(report::enough_words(requirement) == "This is 4 times better than needed.");
}

TEST_CASE("a cheaper camera that is undecided is named beside the one to buy") {
  validate::Requirement requirement = cameras();
  requirement.candidates[0].verdict = validate::Verdict::undecided;
  CHECK_THAT(report::requirement_answer(requirement),
             Contains("One cheaper candidate may be good enough too; more runs would decide"));
}

TEST_CASE("a camera more expensive than the one to buy is said to be not filmed") {
  validate::Requirement requirement = cameras();
  requirement.candidates[2].verdict = validate::Verdict::unconfirmed;
  requirement.candidates[2].judged_by = validate::Confirm::tracks;
  const std::string text = report::requirement_text(requirement);
  CHECK_THAT(
      text,
      Contains(
          "1 of 3 reaches it when filmed; 1 more expensive one reaches it as tracks and was not filmed; 1 does not.") &&
          Contains("possible, not filmed") && !Contains("nothing was run"));
}

TEST_CASE("where nothing reaches the target the nearest is named, with what limits it") {
  validate::Requirement requirement = cameras();
  for (validate::Candidate& candidate : requirement.candidates) candidate.verdict = validate::Verdict::missed;
  requirement.candidates[2].results[0].found = 2e-4;
  requirement.candidates[2].results[0].high = 2.6e-4;
  requirement.candidates[1].results[0].found = 3e-4;
  requirement.candidates[2].limits = {{validate::Limitation::light, 3.0}};
  CHECK_THAT(report::requirement_answer(requirement),
             Contains("Nothing here reaches µ within 0.0001. phone comes nearest. Expect µ within 0.0002 (upper limit "
                      "0.00026): ") &&
                 Contains("Its main limitation: light (no shot noise)"));
  const std::string html = report::requirement_report(requirement).html;
  CHECK_THAT(html,
             Contains("What limits the others") && Contains("<li><b>phone</b>: light (no shot noise): 3.0 times</li>"));
  requirement.candidates[2].verdict = validate::Verdict::reached;
  CHECK_THAT(report::requirement_report(requirement).html, !Contains("<li><b>phone</b>"));
}

TEST_CASE("each row of require names the estimator that judges it, and the runs in which another gave no answer") {
  validate::Requirement requirement = cameras();
  requirement.candidates[0].results[0].runs = 8;
  requirement.candidates[0].results[0].estimator = "phase-diagram";
  requirement.candidates[0].results[0].unanswered = {{"trajectory", 1}};
  const std::string text = report::requirement_text(requirement);
  CHECK_THAT(text, Contains("missed, by clips   lines of the phase diagram"));
  CHECK_THAT(text, Contains("reached, by clips  fit of the whole motion"));
  const std::string told = "µ: no answer with the fit of the whole motion in 1 of 8 runs";
  CHECK_THAT(text, Contains("webcam, 640x480 at 30 fps: " + told));
  const std::string html = report::requirement_report(requirement).html;
  CHECK_THAT(html, Contains(">lines of the phase diagram</td>"));
  CHECK_THAT(html, Contains(told));
}

TEST_CASE("what the bound alone says is what is expected at best") {
  validate::Requirement requirement = cameras();
  requirement.candidates.resize(1);
  requirement.candidates[0].judged_by = validate::Confirm::none;
  requirement.candidates[0].verdict = validate::Verdict::impossible;
  requirement.candidates[0].results = {{4.2e-4, {}, 0.0, 0, 0, ""}};
  CHECK_THAT(report::requirement_answer(requirement),
             Contains("comes nearest. Expect at best µ within 0.00042: judged by the bound alone; nothing was run."));
  // The table has the bounds, not a column of dashes.
  CHECK_THAT(report::requirement_report(requirement).html,
             Contains("bound of the 95 % error of µ") && Contains(">420</td>") && !Contains(">upper limit</th>"));
}
