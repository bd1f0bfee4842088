#include "core/clip_look.h"

#include <algorithm>
#include <cmath>

#include "core/marker.h"
#include "core/marker_search.h"
#include "core/quantile.h"

namespace glidelab::core {
namespace {

constexpr std::size_t kSamples = 24;  // frames with the marker that are looked at closely
constexpr int kPixelStep = 4;
// The squares of the smaller 95 % of normal numbers have 0.759 of their variance.
constexpr double kKept = 0.95, kKeptVariance = 0.759;

/// Squared differences of two frames away from the marker.
void add_differences(const cv::Mat& now, const cv::Mat& before, const MarkerSighting& marker,
                     std::vector<double>& squares) {
  const double away_px = 4.0 * marker.radius_px + 30.0;
  for (int row = 0; row < now.rows; row += kPixelStep) {
    for (int column = 0; column < now.cols; column += kPixelStep) {
      if (std::abs(row - marker.v_px) < away_px) continue;  // the glider moves along rows
      const double difference = now.depth() == CV_8U
                                    ? now.at<std::uint8_t>(row, column) - before.at<std::uint8_t>(row, column)
                                    : now.at<std::uint16_t>(row, column) - before.at<std::uint16_t>(row, column);
      squares.push_back(difference * difference);
    }
  }
}

}  // namespace

ClipLook look_at_clip(const Experiment& experiment, const ClipSetup& clip, const std::vector<MarkerSighting>& sightings,
                      const FrameOpener& open) {
  ClipLook look;
  const SignalKind kind = signal_kind(*experiment.marker);
  const auto source = open(clip.file, *experiment.camera, kind == SignalKind::colored, std::nullopt);
  ExposureWatch watch(experiment.camera->bit_depth);
  const std::size_t every = std::max<std::size_t>(1, sightings.size() / kSamples);
  std::vector<double> contrast, level, squares;
  std::size_t next = 0;
  cv::Mat before;
  while (const auto frame = source->next()) {
    look.size = frame->grey.size();
    watch.add(*frame);
    while (next < sightings.size() && sightings[next].frame < frame->index) next += every;
    if (next < sightings.size() && sightings[next].frame == frame->index) {
      const MarkerSighting& seen = sightings[next];
      if (kind != SignalKind::colored) {
        const auto signal = signal_of(*frame, *experiment.marker, kind);
        MarkerGuess guess;
        guess.centre = {seen.u_px, seen.v_px};
        guess.radius_px = seen.radius_px;
        const auto fit = fit_marker(*signal, guess, Surface::uniform);
        if (fit) {
          contrast.push_back(fit->amplitude);
          if (kind == SignalKind::bright) level.push_back(fit->background + fit->amplitude);
        }
      }
      if (!before.empty()) add_differences(frame->grey, before, seen, squares);
      next += every;
    }
    before = frame->grey;
  }
  look.exposure = watch.result();
  look.file = source->facts();
  const double full = look.exposure.full_code;
  if (!contrast.empty()) look.contrast = quantile(contrast, 0.5) / full;
  if (!level.empty()) look.marker_level = quantile(level, 0.5) / full;
  if (!squares.empty()) {
    const double limit = quantile(squares, kKept);
    double sum = 0.0, count = 0.0;
    for (const double square : squares) {
      if (square > limit) continue;
      sum += square;
      count += 1.0;
    }
    look.pixel_noise = std::sqrt(0.5 * sum / count / kKeptVariance) / full;
  }
  return look;
}

}  // namespace glidelab::core
