#include "diagnose/verdict/diagnose.h"

#include <atomic>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>

#include "base/errors.h"
#include "core/motion/analyze_motion.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"
#include "tests/diagnose/made_nonsense.h"

using namespace glidelab;

namespace {

tests::MadeExperiment analysed(const std::vector<tests::NonsenseClip>& clips) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  tests::MadeExperiment made;
  made.results.gravity_m_s2 = core::kStandardGravity_m_s2;
  made.results.gravity_sd_m_s2 = core::kLocalGravity_sd_m_s2;
  for (const tests::NonsenseClip& clip : clips) {
    core::ClipSetup setup;
    setup.name = clip.name;
    setup.track = clip.name + ".csv";
    setup.mass_kg = clip.mass_kg;
    setup.incline_rad = clip.incline_deg * kDegree;
    setup.incline_sd_rad = clip.incline_sd_deg * kDegree;
    setup.launched = clip.up ? core::Launched::up : core::Launched::down;
    setup.group = clip.name;
    core::TrackData track;
    track.t_s = clip.t_s;
    track.x_m = clip.x_m;
    core::take_rows_as_frames(track);
    made.results.clips.push_back(
        core::analyze_motion(setup, track, core::MotionOptions{.lost_frames = core::LostFrameTimes::kept}));
    made.setups.push_back(std::move(setup));
  }
  return made;
}

}  // namespace

TEST_CASE("motions that no law follows are diagnosed with bounded work, or refused", "[slow]") {
  // Work is counted in reports of progress, of which each fit, scan or search makes one. A diagnosis with six effects
  // and their pairs makes about a hundred.
  constexpr int kMostLooks = 2000;
  int diagnosed = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const std::vector<tests::NonsenseClip> clips = tests::NonsenseMaker(seed).experiment();
    CAPTURE(seed, clips[0].kind, clips[1].kind);
    std::atomic<int> looks = 0;
    try {
      const tests::MadeExperiment made = analysed(clips);
      const diagnose::Diagnosis diagnosis = diagnose::diagnose_results(made.results, made.setups, {.without = {}},
                                                                       [&](std::string_view, double) { ++looks; });
      ++diagnosed;
      CHECK(looks > 0);
      CHECK(std::isfinite(diagnosis.none + diagnosis.unknown));
    } catch (const base::InputError&) {
    } catch (const base::NumericalError&) {
    }
    CHECK(looks < kMostLooks);
  }
  CHECK(diagnosed >= 10);
}
