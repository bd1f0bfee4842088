#include "report/requirement/requirement_words.h"

#include <string>
#include <utility>
#include <vector>

#include "tests/catch.h"

using namespace glidelab;

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
