#include "diagnose/pictures/picture_noise.h"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "diagnose/pictures/noise_law.h"

namespace glidelab::diagnose {

void add_noise(const std::vector<FilmedClip>& clips, PictureEvidence& evidence) {
  std::map<std::size_t, std::vector<core::NoiseAtLevel>> views;
  for (const FilmedClip& clip : clips) {
    auto& levels = views[clip.view];
    levels.insert(levels.end(), clip.record->noise_levels.begin(), clip.record->noise_levels.end());
  }
  for (auto& [view, levels] : views) {
    const std::optional<NoiseLaw> law = noise_law(levels);
    if (!law) continue;
    std::sort(levels.begin(), levels.end(), [](const auto& a, const auto& b) { return a.level_code < b.level_code; });
    PictureCurve curve;
    curve.what = "noise";
    for (const core::NoiseAtLevel& one : levels) {
      curve.at.push_back(one.level_code);
      curve.value.push_back(one.sd_code * one.sd_code);
      curve.sd.push_back(2.0 * one.sd_code * one.known_to);
      curve.fitted.push_back(law->at(one.level_code));
    }
    evidence.curves.push_back(std::move(curve));
  }
}

}  // namespace glidelab::diagnose
