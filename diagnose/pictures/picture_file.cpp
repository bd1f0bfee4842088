#include "diagnose/pictures/picture_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/pictures/scene/codec_blocks.h"
#include "diagnose/effects/effect_library.h"

namespace glidelab::diagnose {
namespace {

constexpr double kMemory = 0.05;      // of a ratio of variances that should be 1: what it errs by,
constexpr double kUsualMemory = 1.1;  // and what it is where nothing is wrong

}  // namespace

double memory_log_evidence(const std::vector<FilmedClip>& clips) {
  double memory = 1.0;
  for (const FilmedClip& clip : clips) memory = std::max(memory, clip.record->noise_memory.value_or(1.0));
  return log_evidence_of((memory - kUsualMemory) / kMemory, 1.0 / kMemory);
}

void add_codec(const std::vector<FilmedClip>& clips, PictureEvidence& evidence) {
  double excess = 0.0, relative = 0.0, memory = 0.0;
  std::size_t lossy = 0, lossless = 0;
  std::string codec, lossy_codec;
  for (const FilmedClip& clip : clips) {
    const core::BlockEdges edges = core::block_edges(clip.record->steps);
    if (edges.z > excess) {
      excess = edges.z;
      relative = edges.relative;
    }
    memory = std::max(memory, clip.record->noise_memory.value_or(1.0));
    if (clip.record->lossy) ++(*clip.record->lossy ? lossy : lossless);
    if (codec.empty()) codec = clip.record->codec;
    if (lossy_codec.empty() && clip.record->lossy.value_or(false)) lossy_codec = clip.record->codec;
  }
  const bool changes = std::any_of(evidence.findings.begin(), evidence.findings.end(), [](const PictureFinding& other) {
    return (other.id == ids::light_flicker || other.id == ids::camera_motion) && other.log_evidence > kSeenInPictures;
  });
  PictureFinding finding = finding_of(ids::compression);
  const double blocks = log_evidence_of((excess - 3.0) / 2.0, 100.0);  // of columns that tell their scatter poorly
  // A file that says that it is compressed with loss withholds nothing: it is named for what it does to the positions.
  finding.stated = lossy > 0;
  finding.log_evidence =
      std::max(lossy > 0 ? std::max(-1.0, blocks) : blocks, changes ? blocks : memory_log_evidence(clips));
  finding.parameters = {{"block_steps", relative, relative / std::max(1.0, excess)}};
  if (!lossy_codec.empty()) finding.parameters.push_back({"codec", 0.0, 0.0, lossy_codec});
  const std::string steps =
      relative > 2.0 ? fmt::format("{:.2g} times as large", 1.0 + relative)
                     : fmt::format("{:.1f} % {}", 100.0 * std::abs(relative), relative < 0.0 ? "smaller" : "larger");
  finding.words = fmt::format("{}; steps between pixels are {} at the edges of 8 × 8 blocks {} elsewhere.",
                              lossy > 0      ? fmt::format("The file is compressed with loss ({})", lossy_codec)
                              : lossless > 0 ? fmt::format("The file is compressed without loss ({})", codec)
                                             : std::string("What the file was compressed with is not known"),
                              steps, relative > 2.0 ? "as" : "than");
  if (memory > kUsualMemory)
    finding.words +=
        fmt::format(" Noise lasts over frames (changes over two frames are {:.2f} times those over one).", memory);
  evidence.findings.push_back(std::move(finding));
}

void add_missing(const std::vector<FilmedClip>& clips, PictureEvidence& evidence) {
  std::size_t missing = 0, repeated = 0, frames = 0;
  for (const FilmedClip& clip : clips) {
    missing += clip.record->stamps_missing;
    const auto& looks = clip.record->marker;
    frames += looks.size();
    for (std::size_t i = 2; i < looks.size(); ++i) {
      const bool same = looks[i].u_px == looks[i - 1].u_px && looks[i].v_px == looks[i - 1].v_px;
      if (same && std::abs(looks[i - 1].u_px - looks[i - 2].u_px) > 0.05) ++repeated;
    }
  }
  if (missing + repeated == 0) return;
  PictureFinding finding = finding_of(ids::dropped_frames);
  finding.log_evidence = std::min(50.0, 5.0 * static_cast<double>(missing + repeated));
  const double count = static_cast<double>(missing + repeated);
  finding.parameters = {
      {"fraction", count / static_cast<double>(frames), std::sqrt(count) / static_cast<double>(frames)}};
  finding.words =
      fmt::format("{} frames repeat the image before, and the time stamps leave a gap for {}.", repeated, missing);
  evidence.findings.push_back(std::move(finding));
}

}  // namespace glidelab::diagnose
