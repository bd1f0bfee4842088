#include "diagnose/verdict_regions.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace glidelab::diagnose {
namespace {

constexpr double kNotable = 3.0;  // log evidence of an unnamed family that is worth a region
constexpr std::size_t kMostRegions = 6;
constexpr std::size_t kMostCurves = 4;

}  // namespace

void add_regions(const TrackSet& set, const std::vector<UnnamedFamily>& families, Diagnosis& diagnosis) {
  std::vector<const UnnamedFamily*> sorted;
  for (const UnnamedFamily& family : families) sorted.push_back(&family);
  std::sort(sorted.begin(), sorted.end(),
            [](const auto* a, const auto* b) { return a->log_evidence > b->log_evidence; });
  const double notable = kNotable + std::log(static_cast<double>(families.size()));  // as many looks were taken
  for (const UnnamedFamily* family : sorted) {
    // What a verdict rests on has its place named, however many looks there were.
    const bool rests = diagnosis.verdict == "unknown" && diagnosis.regions.empty() && family == sorted.front();
    if (family->log_evidence < (rests ? 0.0 : notable)) break;
    const bool drawn = std::any_of(diagnosis.curves.begin(), diagnosis.curves.end(), [&](const GapCurve& curve) {
      return curve.variable == family->variable && curve.what == family->what;
    });
    if (drawn) continue;  // the same at another width
    if (family->names.empty() && !family->at.empty() && diagnosis.curves.size() < kMostCurves) {
      diagnosis.curves.push_back(
          {family->variable, family->what, family->unit, family->log_evidence, family->at, family->size, family->sd});
    }
    std::vector<UnnamedRegion> regions = family->regions;
    std::sort(regions.begin(), regions.end(), [](const auto& a, const auto& b) { return a.excess > b.excess; });
    for (std::size_t r = 0; r < regions.size() && r < 2 && diagnosis.regions.size() < kMostRegions; ++r) {
      GapRegion region{family->variable, regions[r].from, regions[r].to, regions[r].excess,
                       regions[r].size,  family->unit,    family->what,  ""};
      if (family->variable == "clip") {  // a clip as a whole
        const auto& clip = set.clips[static_cast<std::size_t>(std::lround(regions[r].from))];
        region.variable = std::string("t_s");
        region.clip = clip.name;
        region.from = 0.0;
        region.to = clip.duration_s;
      }
      diagnosis.regions.push_back(region);
    }
  }
}

bool add_error_runs(const TrackSet& set, const std::vector<FrameEffect>& frames,
                    const std::vector<UnnamedFamily>& families, Diagnosis& diagnosis) {
  double most = kNotable;
  for (const UnnamedFamily& family : families) most = std::max(most, family.log_evidence);
  bool any = false;
  for (const FrameEffect& frame : frames) {
    if (!frame.run || frame.in_runs < kNotable || frame.log_evidence + frame.in_runs < most) continue;
    const std::string clip = frame.run->clip ? set.clips[*frame.run->clip].name : "";
    diagnosis.regions.push_back(
        {"t_s", frame.run->from_s, frame.run->to_s, frame.run->excess, frame.run->size_m, "m", "displacement", clip});
    any = true;
  }
  return any;
}

void add_picture_regions(const PictureEvidence& pictures, Diagnosis& diagnosis) {
  static const std::map<std::string, std::pair<const char*, const char*>> kWhere = {
      {"exposure_blur", {"v_m_s", "marker's width"}},  {"rolling_shutter", {"v_px", "marker's shear"}},
      {"light_flicker", {"t_s", "brightness"}},        {"light_gradient", {"u_px", "brightness"}},
      {"camera_motion", {"t_s", "the scene's place"}}, {"compression", {"u_px", "steps between blocks"}}};
  for (const DiagnosedEffect& effect : diagnosis.effects) {
    for (const PictureFinding& finding : pictures.findings) {
      const auto where = kWhere.find(finding.id);
      if (finding.id != effect.id || !finding.seen || where == kWhere.end() || finding.parameters.empty()) continue;
      GapRegion region;
      region.variable = where->second.first;
      region.what = where->second.second;
      const core::PictureRecord& record = *pictures.clips.front().record;
      region.to = region.variable == "u_px"   ? record.width_px
                  : region.variable == "v_px" ? record.height_px
                  : record.scene.empty()      ? 0.0
                                              : record.scene.back().t_s;
      if (region.variable == "v_m_s" && pictures.clips.front().px_per_m > 0.0) {
        region.to = pictures.fastest_px_s / pictures.clips.front().px_per_m;
      }
      const DiagnosedParameter& size = finding.parameters.front();
      region.size = size.value;
      region.unit = size.key;
      region.excess = std::sqrt(2.0 * finding.log_evidence);
      diagnosis.regions.push_back(region);
    }
  }
}

}  // namespace glidelab::diagnose
