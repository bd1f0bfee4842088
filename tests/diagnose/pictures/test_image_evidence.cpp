#include "diagnose/pictures/image_evidence.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <variant>

#include "diagnose/pictures/image_recording.h"
#include "diagnose/pictures/image_scene.h"
#include "diagnose/pictures/image_search.h"
#include "diagnose/verdict/verdict_details.h"
#include "diagnose/weigh/joined_evidence.h"
#include "tests/catch.h"

using namespace glidelab;

namespace {

struct Made {
  double exposure_s = 0.001, line_s = 0.0, flicker = 0.0, sway_px = 0.0;
};

/// Two clips at 120 Hz, 150 frames each: a marker of 6 px radius that slows down from 400 px/s and one that speeds up
/// over the same places; its shape, the light and the scene's place with noise.
std::vector<diagnose::FilmedClip> filmed(const Made& made, double stated_s, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::vector<diagnose::FilmedClip> clips;
  for (const double direction : {1.0, -1.0}) {
    auto record = std::make_shared<core::ImageRecord>();
    record->width_px = 480;
    record->height_px = 180;
    record->codec = "FFV1";
    record->lossy = false;
    record->steps.mean.fill(1.0);
    record->noise_memory = 1.0;
    for (std::size_t k = 0; k < 150; ++k) {
      const double t = static_cast<double>(k) / 120.0, speed = direction > 0.0 ? 400.0 - 250.0 * t : -120.0 - 100.0 * t;
      core::MarkerLook look;
      look.frame = k;
      look.t_s = t;
      look.u_px = (direction > 0.0 ? 30.0 + 400.0 * t - 125.0 * t * t : 450.0 - 120.0 * t - 50.0 * t * t) +
                  0.01 * normal(random);
      look.v_px = 90.0 + 0.01 * normal(random);
      const double smear = speed * made.exposure_s, z = look.u_px / 480.0;
      look.vv_px2 = 9.0;
      look.stretch_px2 = 0.2 - 0.3 * z + 0.1 * z * z + smear * smear / 12.0 + 0.06 * normal(random);
      look.uv_px2 = 0.05 * z + made.line_s * speed * 9.0 + 0.01 * normal(random);
      look.amplitude = 150.0;
      look.background = 40.0;
      record->marker.push_back(look);
      core::SceneLook scene;
      scene.frame = k;
      scene.t_s = t;
      scene.u_px = made.sway_px * std::sin(2.0 * std::numbers::pi * 7.0 * t + direction) + 0.02 * normal(random);
      scene.v_px = 0.005 * normal(random);
      scene.sd_u_px = 0.02;
      scene.sd_v_px = 0.005;
      scene.gain.fill(made.flicker * std::cos(2.0 * std::numbers::pi * 100.0 * t + direction) +
                      0.0004 * normal(random));
      scene.gain_sd.fill(0.0004);
      record->scene.push_back(scene);
    }
    diagnose::FilmedClip clip;
    clip.name = direction > 0.0 ? "down" : "up";
    clip.record = record;
    clip.camera.frame_rate_hz = 120.0;
    clip.camera.exposure_s = stated_s;
    clip.px_per_m = 400.0;
    clips.push_back(clip);
  }
  return clips;
}

/// A copy: the evidence may be gone before it is looked at.
diagnose::ImageFinding finding(const diagnose::ImageEvidence& evidence, const std::string& id) {
  const auto found =
      std::find_if(evidence.findings.begin(), evidence.findings.end(), [&](const auto& f) { return f.id == id; });
  REQUIRE(found != evidence.findings.end());
  return *found;
}

}  // namespace

TEST_CASE("Exposure and line time come out of the marker's shape within their standard deviations", "[pictures]") {
  const diagnose::ShapeFit fit = diagnose::fit_marker_shape(filmed({0.006, 3e-5, 0.0, 0.0}, 0.001, 3));
  REQUIRE(fit.known);
  // Five standard deviations of two numbers: 1e-6 by chance.
  CHECK(std::abs(fit.exposure_s - 0.006) < 5.0 * fit.exposure_sd_s);
  CHECK(std::abs(fit.line_s - 3e-5) < 5.0 * fit.line_sd_s);
  // sd of T: (0.06 px²) / (w² T/6) a frame at w = 300 px/s, over 290 frames of which some half tell.
  CHECK(fit.exposure_sd_s < 0.0006);
  CHECK(fit.line_sd_s < 2e-6);
}

TEST_CASE("an outline that is fitted with a fixed shape tells no exposure and no shutter", "[pictures]") {
  std::vector<diagnose::FilmedClip> clips = filmed({0.003, 0.0, 0.0, 0.0}, 0.001, 1);
  for (diagnose::FilmedClip& clip : clips) {
    auto record = std::make_shared<core::ImageRecord>(*clip.record);
    for (core::MarkerLook& look : record->marker) look.stretch_px2 = look.uv_px2 = 0.0;
    clip.record = record;
  }
  CHECK_FALSE(diagnose::fit_marker_shape(clips).known);
  for (const diagnose::ImageFinding& one : diagnose::image_evidence(clips).findings) {
    CAPTURE(one.id);
    CHECK((std::isfinite(one.log_evidence) && one.id != "exposure_blur" && one.id != "rolling_shutter"));
  }
}

TEST_CASE("compression has the name of the codec with loss that a file states, and else none", "[pictures]") {
  std::vector<diagnose::FilmedClip> clips = filmed({0.003, 0.0, 0.0, 0.0}, 0.003, 1);
  REQUIRE(clips.size() >= 2);
  const auto codecs = [&clips] {
    std::string words;
    for (const auto& p : finding(diagnose::image_evidence(clips), "compression").parameters) {
      if (p.key == "codec") words += p.text;
    }
    return words;
  };
  CHECK(codecs().empty());
  auto record = std::make_shared<core::ImageRecord>(*clips.back().record);
  record->codec = "MJPG";
  record->lossy = true;
  clips.back().record = record;
  CHECK(codecs() == "MJPG");
}

TEST_CASE("Images in which all is as stated show nothing", "[pictures]") {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const diagnose::ImageEvidence evidence = diagnose::image_evidence(filmed({0.003, 0.0, 0.0, 0.0}, 0.003, seed));
    CHECK(evidence.findings.size() == 6);
    for (const auto& one : evidence.findings) {
      INFO(one.id << ", seed " << seed);
      CHECK_FALSE(one.seen);
    }
  }
}

TEST_CASE("Each thing that images alone can tell is seen where it is, and nothing else with it", "[pictures]") {
  const std::vector<std::pair<std::string, Made>> cases = {{"exposure_blur", {0.007, 0.0, 0.0, 0.0}},
                                                           {"rolling_shutter", {0.001, 3e-5, 0.0, 0.0}},
                                                           {"light_flicker", {0.001, 0.0, 0.02, 0.0}},
                                                           {"camera_motion", {0.001, 0.0, 0.0, 0.2}}};
  for (const auto& [id, made] : cases) {
    const diagnose::ImageEvidence evidence = diagnose::image_evidence(filmed(made, 0.001, 5));
    for (const auto& one : evidence.findings) {
      INFO("made " << id << ", looked at " << one.id);
      CHECK(one.seen == (one.id == id));
    }
  }
  const diagnose::ImageFinding flicker =
      finding(diagnose::image_evidence(filmed({0.001, 0.0, 0.02, 0.0}, 0.001, 5)), "light_flicker");
  // 100 Hz at 120 frames a second is seen as 20 Hz; the exposure of 1 ms passes 0.984 of the depth.
  CHECK(flicker.parameters[1].value == 100.0);
  CHECK(std::abs(flicker.parameters[0].value - 0.02 / 0.9836) < 5.0 * flicker.parameters[0].sd);
}

TEST_CASE("A camera's sway in the tracks is borne out by a scene that sways as much, and refuted by one at rest",
          "[pictures]") {
  const auto swaying = filmed({0.001, 0.0, 0.0, 0.2}, 0.001, 8), resting = filmed({}, 0.001, 8);
  CHECK(diagnose::camera_sway_support(swaying, 0.2 / 400.0, 7.0) > 50.0);
  CHECK(diagnose::camera_sway_support(resting, 0.2 / 400.0, 7.0) < -20.0);
  // Too small to be seen in the scene: neither.
  CHECK(std::abs(diagnose::camera_sway_support(resting, 0.001 / 400.0, 7.0)) < 1.0);
}

TEST_CASE("A camera that drifts along the track falsifies speeds by the drift's own, which is told", "[pictures]") {
  constexpr double kDrift_px_s = 1.2;
  std::vector<diagnose::FilmedClip> clips = filmed({}, 0.001, 8);
  for (diagnose::FilmedClip& clip : clips) {
    auto record = std::make_shared<core::ImageRecord>(*clip.record);
    for (core::SceneLook& look : record->scene) look.u_px -= kDrift_px_s * look.t_s;
    clip.record = record;
  }
  const diagnose::ImageFinding found = finding(diagnose::image_evidence(clips), "camera_motion");
  REQUIRE(std::holds_alternative<diagnose::image::Sway>(found.fact));
  const auto& sway = std::get<diagnose::image::Sway>(found.fact);
  REQUIRE(sway.how == diagnose::image::Sway::How::drifts);
  // 400 px a metre. The slope through 150 points of 0.02 px over 1.25 s is known to 0.02 sqrt(12/150) / 1.25 px/s.
  CHECK(std::abs(sway.speed_m_s - kDrift_px_s / 400.0) < 5.0 * 0.0045 / 400.0);
}

TEST_CASE("A camera that sways in the images alone has no more support than one that sways so in the tracks as well",
          "[pictures]") {
  constexpr double kSway_px = 0.05, kSway_hz = 7.0;
  std::vector<diagnose::FilmedClip> clips = filmed({0.001, 0.0, 0.0, kSway_px}, 0.001, 8);
  for (diagnose::FilmedClip& clip : clips) {  // seen far better than a patch is trusted to
    auto record = std::make_shared<core::ImageRecord>(*clip.record);
    for (core::SceneLook& look : record->scene) {
      const double wave = kSway_px * std::sin(2.0 * std::numbers::pi * kSway_hz * look.t_s);
      look.u_px = wave + 1e-3 * (look.u_px - wave);
      look.sd_u_px = 1e-4;
    }
    clip.record = record;
  }
  const diagnose::ImageEvidence images = diagnose::image_evidence(clips);
  const double in_tracks = diagnose::camera_sway_support(clips, kSway_px / 400.0, kSway_hz);
  REQUIRE(in_tracks > 20.0);
  const double by_images = finding(images, "camera_motion").log_evidence;
  diagnose::Comparison comparison;
  comparison.all.emplace_back();
  diagnose::join_images({}, images, {}, comparison);
  const auto joined = std::find_if(comparison.all.begin(), comparison.all.end(), [](const auto& one) {
    return one.effects == std::vector<std::size_t>{diagnose::effect_index("camera_motion")};
  });
  REQUIRE(joined != comparison.all.end());
  REQUIRE(by_images > 2.0 * in_tracks);
  CHECK(joined->log_evidence < 1.05 * in_tracks);
}

TEST_CASE("Clips whose marker is a target, of which no looks are kept, count for what their images show",
          "[pictures]") {
  core::AnalysisResults results;
  core::ClipResult clip;
  clip.name = "up";
  clip.experiment = "made";
  auto record = std::make_shared<core::ImageRecord>(*filmed({}, 0.001, 8).front().record);
  record->marker.clear();
  record->codec = "avc1";
  record->lossy = true;
  clip.images = record;
  for (std::size_t k = 0; k < 100; ++k) {
    core::MotionPoint point;
    point.measured_m = 0.002 * static_cast<double>(k);
    clip.motion.push_back(point);
    clip.sightings.push_back({.frame = k, .u_px = 90.0, .v_px = 20.0 + 0.8 * static_cast<double>(k)});
  }
  results.clips = {clip};
  core::CameraSettings camera;
  camera.frame_rate_hz = 120.0;
  const std::vector<diagnose::FilmedClip> clips = diagnose::filmed_clips(results, {core::ClipSetup{}}, {camera});
  REQUIRE(clips.size() == 1);
  CHECK(clips.front().px_per_m == Approx(400.0));
  CHECK(clips.front().down);
  const diagnose::ImageEvidence images = diagnose::image_evidence(clips);
  CHECK(finding(images, "compression").stated);
  CHECK(finding(images, "camera_motion").log_evidence < 0.0);
}

namespace {

/// The same clip with the camera turned by 90 degrees: columns become rows.
diagnose::FilmedClip turned(const diagnose::FilmedClip& clip) {
  diagnose::FilmedClip down = clip;
  auto record = std::make_shared<core::ImageRecord>(*clip.record);
  std::swap(record->width_px, record->height_px);
  for (core::MarkerLook& look : record->marker) std::swap(look.u_px, look.v_px);
  for (core::SceneLook& look : record->scene) {
    std::swap(look.u_px, look.v_px);
    std::swap(look.sd_u_px, look.sd_v_px);
  }
  down.record = std::move(record);
  down.down = !clip.down;
  return down;
}

}  // namespace

TEST_CASE("a sway along a motion down the image is borne out by the scene as the same sway across it", "[pictures]") {
  const auto across = filmed({.sway_px = 0.6}, 0.001, 3);
  std::vector<diagnose::FilmedClip> down;
  for (const diagnose::FilmedClip& clip : across) down.push_back(turned(clip));
  const double amplitude_m = 0.6 / across.front().px_per_m;
  const double support = diagnose::camera_sway_support(across, amplitude_m, 7.0);
  CHECK(support > 0.0);
  CHECK(diagnose::camera_sway_support(down, amplitude_m, 7.0) == Approx(support).epsilon(1e-9));
}

TEST_CASE("an image that is repeated is found in a motion down the image as in one across it", "[pictures]") {
  std::vector<diagnose::FilmedClip> across = filmed({}, 0.001, 3), down;
  auto record = std::make_shared<core::ImageRecord>(*across.front().record);
  record->marker[60].u_px = record->marker[59].u_px;
  record->marker[60].v_px = record->marker[59].v_px;
  across.front().record = record;
  for (const diagnose::FilmedClip& clip : across) {
    down.push_back(turned(clip));
    // Nothing moves across.
    auto still = std::make_shared<core::ImageRecord>(*down.back().record);
    for (core::MarkerLook& look : still->marker) look.u_px = 90.0;
    down.back().record = std::move(still);
  }
  for (const auto* clips : {&across, &down}) {
    diagnose::ImageEvidence evidence;
    diagnose::add_missing(*clips, evidence);
    REQUIRE(evidence.findings.size() == 1);
    CHECK(std::get<diagnose::image::FrameTimes>(evidence.findings.front().fact).repeated == 1);
  }
}

TEST_CASE("clips of several cameras are each held to what is stated of their own") {
  const auto blur_of = [](double first_s, double second_s, double second_stated_s) {
    std::vector<diagnose::FilmedClip> clips = filmed({.exposure_s = first_s}, first_s, 61);
    for (diagnose::FilmedClip& clip : filmed({.exposure_s = second_s}, second_stated_s, 62)) {
      clip.view = 1;
      clips.push_back(clip);
    }
    return finding(diagnose::image_evidence(clips), "exposure_blur");
  };
  CHECK(blur_of(0.001, 0.008, 0.008).log_evidence < 0.0);  // eight times the first one's, as stated
  const diagnose::ImageFinding longer = blur_of(0.005, 0.006, 0.001);
  CHECK(longer.log_evidence > 5.0);
  CHECK(std::abs(longer.parameters.front().value - 0.006) < 4.0 * longer.parameters.front().sd);
}

TEST_CASE("an outline that shears by more than any shutter is no rolling shutter", "[pictures]") {
  // A frame of 180 rows at 120 Hz is read within 46 us a row.
  CHECK(finding(diagnose::image_evidence(filmed({.line_s = 4e-5}, 0.001, 65)), "rolling_shutter").log_evidence > 5.0);
  CHECK(finding(diagnose::image_evidence(filmed({.line_s = 1e-4}, 0.001, 65)), "rolling_shutter").log_evidence < 0.0);
}

TEST_CASE("the stated line time that goes with a rolling shutter is that of the camera that shows it") {
  std::vector<diagnose::FilmedClip> clips = filmed({}, 0.001, 63);  // a global shutter, as stated
  for (diagnose::FilmedClip& clip : filmed({.line_s = 4e-5}, 0.001, 64)) {
    clip.view = 1;
    clip.camera.shutter = core::Shutter::rolling;
    clip.camera.line_readout_s = 1e-5;
    clips.push_back(clip);
  }
  const diagnose::ImageEvidence evidence = diagnose::image_evidence(clips);
  CHECK(finding(evidence, "rolling_shutter").log_evidence > 5.0);
  CHECK(evidence.stated_line_s == 1e-5);
}

namespace {

/// What a camera sees that is turned by a right angle: columns for rows.
std::vector<diagnose::FilmedClip> turned(std::vector<diagnose::FilmedClip> clips) {
  for (diagnose::FilmedClip& clip : clips) {
    auto record = std::make_shared<core::ImageRecord>(*clip.record);
    std::swap(record->width_px, record->height_px);
    for (core::MarkerLook& look : record->marker) {
      std::swap(look.u_px, look.v_px);
      look.vv_px2 += look.stretch_px2;
      look.stretch_px2 = -look.stretch_px2;
    }
    for (core::SceneLook& scene : record->scene) {
      std::swap(scene.u_px, scene.v_px);
      std::swap(scene.sd_u_px, scene.sd_v_px);
    }
    clip.record = record;
    clip.down = true;
  }
  return clips;
}

/// The marker is brighter by this a metre along its path, and as bright as before at 450 px.
std::vector<diagnose::FilmedClip> with_gradient(std::vector<diagnose::FilmedClip> clips, double gradient_1_m) {
  for (diagnose::FilmedClip& clip : clips) {
    auto record = std::make_shared<core::ImageRecord>(*clip.record);
    for (core::MarkerLook& look : record->marker)
      look.amplitude *= std::exp(gradient_1_m * (look.u_px - 450.0) / clip.px_per_m);
    clip.record = record;
  }
  return clips;
}

diagnose::image::LightAlong light_of(const diagnose::ImageEvidence& evidence) {
  return std::get<diagnose::image::LightAlong>(finding(evidence, "light_gradient").fact);
}

}  // namespace

TEST_CASE("light from one side is told with how far it draws the centroid of the marker's light", "[pictures]") {
  const auto even = with_gradient(filmed({0.006, 0.0, 0.0, 0.0}, 0.006, 4), 1.5);
  CHECK_FALSE(light_of(diagnose::image_evidence(even)).pull);
  auto drawn = even;
  for (diagnose::FilmedClip& clip : drawn) {
    auto record = std::make_shared<core::ImageRecord>(*clip.record);
    std::size_t k = 0;
    // In turn five values from -0.4 to -0.8 px: median 0.6, half the range 0.2.
    for (core::MarkerLook& look : record->marker) look.light_u_px = -0.4 - 0.1 * static_cast<double>(k++ % 5);
    clip.record = record;
  }
  const auto pull = light_of(diagnose::image_evidence(drawn)).pull;
  REQUIRE(pull);
  CHECK(pull->size_px == Approx(0.6));
  CHECK(pull->change_px == Approx(0.2));
}

TEST_CASE("light along the path is that on the brighter of a marker and what is behind it", "[pictures]") {
  // A dark marker on a card under light of exp(-0.6 s), with glare that lifts its black towards the other side.
  auto dark = filmed({0.006, 0.0, 0.0, 0.0}, 0.006, 4);
  for (diagnose::FilmedClip& clip : dark) {
    auto record = std::make_shared<core::ImageRecord>(*clip.record);
    for (core::MarkerLook& look : record->marker) {
      const double s = (look.u_px - 240.0) / clip.px_per_m;
      look.background = 150.0 * std::exp(-0.6 * s);
      look.amplitude = 20.0 + 15.0 * s - look.background;
    }
    clip.record = record;
  }
  const diagnose::image::LightAlong light = light_of(diagnose::image_evidence(dark));
  // Exact data; the normal equations have a ridge of 1e-9, and place and speed are alike to a few parts in a thousand.
  CHECK(std::abs(light.gradient_1_m + 0.6) < 1e-5);
}

TEST_CASE("a marker that is paler where it is faster, as a long exposure makes it, shows no light along the path",
          "[pictures]") {
  std::vector<diagnose::FilmedClip> clips = filmed({0.006, 0.0, 0.0, 0.0}, 0.006, 4);
  bool down = true;
  for (diagnose::FilmedClip& clip : clips) {
    auto record = std::make_shared<core::ImageRecord>(*clip.record);
    for (core::MarkerLook& look : record->marker) {
      const double speed_px_s = down ? 400.0 - 250.0 * look.t_s : 120.0 + 100.0 * look.t_s;
      look.amplitude = 190.0 * std::exp(-0.8 * speed_px_s / 400.0) - look.background;
    }
    clip.record = record;
    down = false;
  }
  const diagnose::ImageFinding light = finding(diagnose::image_evidence(clips), "light_gradient");
  CHECK_FALSE(light.seen);
  CHECK(std::abs(std::get<diagnose::image::LightAlong>(light.fact).gradient_1_m) < 0.05);
  CHECK(finding(diagnose::image_evidence(with_gradient(clips, 1.5)), "light_gradient").seen);
}

TEST_CASE("a motion down the image tells exposure and light as the same motion across it does", "[pictures]") {
  const auto across = with_gradient(filmed({0.006, 0.0, 0.0, 0.0}, 0.006, 4), 1.5);
  const auto down = turned(across);
  const diagnose::ShapeFit of_across = diagnose::fit_marker_shape(across), of_down = diagnose::fit_marker_shape(down);
  REQUIRE(of_down.known);
  CHECK(std::abs(of_down.exposure_s - 0.006) < 5.0 * of_down.exposure_sd_s);
  // Down the image a line time would stretch the marker too, as speed does and not as its square: known less well.
  CHECK(of_down.exposure_sd_s < 2.0 * of_across.exposure_sd_s);
  const auto light_across = finding(diagnose::image_evidence(across), "light_gradient");
  const auto light_down = finding(diagnose::image_evidence(down), "light_gradient");
  CHECK(light_down.parameters[0].value == Approx(light_across.parameters[0].value).epsilon(1e-6));
  CHECK(std::get<diagnose::image::LightAlong>(light_down.fact).down);
  CHECK_FALSE(std::get<diagnose::image::LightAlong>(light_across.fact).down);
  CHECK(light_down.seen == light_across.seen);
}

TEST_CASE("what images show of a named effect is told over the variable in which it is seen", "[pictures]") {
  using diagnose::GapKind, diagnose::GapVariable;
  struct Seen {
    const char* id;
    std::vector<diagnose::FilmedClip> clips;
    GapVariable over;
    GapKind what;
    double to;
  };
  const auto bright = with_gradient(filmed({0.006, 0.0, 0.0, 0.0}, 0.006, 4), 1.5);
  // 480 x 180 pixels, or turned 180 x 480; 150 frames at 120 Hz; at most 400 px/s by 400 px/m.
  for (const Seen& seen :
       {Seen{"light_gradient", bright, GapVariable::column, GapKind::brightness, 480.0},
        Seen{"light_gradient", turned(bright), GapVariable::row, GapKind::brightness, 480.0},
        Seen{"exposure_blur", filmed({0.007, 0.0, 0.0, 0.0}, 0.001, 5), GapVariable::speed, GapKind::marker_width, 1.0},
        Seen{"rolling_shutter", filmed({0.001, 3e-5, 0.0, 0.0}, 0.001, 5), GapVariable::row, GapKind::marker_shear,
             180.0},
        Seen{"light_flicker", filmed({0.001, 0.0, 0.02, 0.0}, 0.001, 5), GapVariable::time, GapKind::brightness,
             149.0 / 120.0}}) {
    INFO(seen.id);
    const diagnose::ImageEvidence evidence = diagnose::image_evidence(seen.clips);
    const diagnose::ImageFinding found = finding(evidence, seen.id);
    diagnose::Diagnosis diagnosis;
    diagnosis.effects.resize(2);
    diagnosis.effects[0].id = seen.id;
    diagnosis.effects[1].id = "tether";  // of which images show nothing
    diagnose::add_image_regions(evidence, diagnosis);
    REQUIRE(diagnosis.regions.size() == 1);
    const diagnose::GapRegion& region = diagnosis.regions.front();
    CHECK(region.variable == seen.over);
    CHECK(region.what == seen.what);
    CHECK(region.from == 0.0);
    // A speed is that of a line through some frames, in which it changes by a part in a hundred.
    CHECK(region.to == Approx(seen.to).epsilon(seen.over == GapVariable::speed ? 0.05 : 1e-12));
    CHECK(region.size == found.parameters.front().value);
    CHECK(region.unit == found.parameters.front().key);
    CHECK(region.excess == Approx(std::sqrt(2.0 * found.log_evidence)).epsilon(1e-12));
    diagnosis.effects.erase(diagnosis.effects.begin());
    diagnosis.regions.clear();
    diagnose::add_image_regions(evidence, diagnosis);
    CHECK(diagnosis.regions.empty());
  }
}
