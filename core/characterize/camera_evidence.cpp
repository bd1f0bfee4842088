#include "core/characterize/camera_evidence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/errors.h"
#include "core/characterize/pixel_response.h"

namespace glidelab::core {
namespace {

constexpr double kLinearRange = 0.7;          // of saturation; EMVA 1288
constexpr double kMostClippedPart = 1e-3;     // of the samples: changes a variance by less than its error
constexpr double kLeastShareOfPixels = 0.25;  // of the image, for a level to count
// If rounding may change a variance by more than this fraction, the set does not show its noise. The limit of EMVA 1288
// (0.24 DN², quantisation included) comes to 0.2 without a spread of the means.
constexpr double kRoundingAllowed = 0.2;

class Gatherer {
 public:
  Gatherer(const FlatFieldFolder& folder, const base::Progress& progress) : folder_(folder), progress_(progress) {}

  CameraEvidence gather() {
    read_darks();
    read_flats();
    check_light();
    evidence().saturation = find_saturation(dark(), evidence().flats, folder_.largest_code());
    choose_levels();
    find_middle_level();
    if (out_.middle_level) measure_patterns();
    return std::move(out_);
  }

 private:
  Evidence& evidence() { return out_.evidence; }

  FlatFieldStack stack(const FrameSet& set) {
    progress_("reading " + set.name, static_cast<double>(steps_++) / (2.0 + static_cast<double>(folder_.darks.size()) +
                                                                      static_cast<double>(folder_.flats.size())));
    return stack_frames(set, form_, folder_.largest_code(), out_.grid, mask_);
  }

  void read_darks() {
    form_ = form_of(folder_.darks.front().files.front(), folder_.most_pixels);
    if (form_.depth == CV_8U && folder_.bit_depth > 8) {
      throw base::InputError(base::Issue{form_.named, 0, "", "an image of 8 bits",
                                         fmt::format("16 bits for codes of bit_depth = {}", folder_.bit_depth)});
    }
    out_.grid = TileGrid(form_.size);
    mask_ = cv::Mat(form_.size, CV_8U, cv::Scalar(255));
    find_hot_pixels(stack(folder_.darks.front()));
    for (const FrameSet& set : folder_.darks) {
      evidence().darks.push_back(stack(set));
      evidence().exposure_s.push_back(set.exposure_s);
      out_.frames += set.files.size();
    }
    out_.dark_clipped = dark().all.at_zero > kMostClippedPart;
  }

  const FlatFieldStack& dark() { return evidence().darks.front(); }

  void find_hot_pixels(const FlatFieldStack& stack) {
    const cv::Mat deviation = stack.mean_dn - neighbourhood_median(stack.mean_dn, false);
    // If the codes hardly change, the means of the frames scatter in steps.
    const double step = std::sqrt(kQuantisation / static_cast<double>(stack.frames));
    const double limit = kOutlierSd * std::max(robust_sd(deviation, mask_), step);
    const cv::Mat hot = deviation > limit;
    const cv::Mat cold = deviation < -limit;
    out_.hot_pixels = static_cast<std::size_t>(cv::countNonZero(hot));
    mask_.setTo(0, hot | cold);
    out_.outlying_pixels = out_.hot_pixels + static_cast<std::size_t>(cv::countNonZero(cold));
  }

  void read_flats() {
    for (const FrameSet& set : folder_.flats) {
      evidence().flats.push_back(stack(set));
      evidence().flats.back().mean_dn.release();  // a hundred levels of 20 megapixels would be 16 GiB
      evidence().flats.back().contrast_dn.release();
      out_.frames += set.files.size();
    }
  }

  void check_light() {
    double brightest_dn = 0.0;
    double least_saturated = 1.0;
    for (const FlatFieldStack& flat : evidence().flats) {
      brightest_dn = std::max(brightest_dn, flat.all.mean_dn - dark().all.mean_dn);
      least_saturated = std::min(least_saturated, flat.all.at_largest);
    }
    const std::string where = folder_.flats.front().files.front().parent_path().parent_path().string();
    if (brightest_dn < 1.0) {
      throw base::InputError(
          base::Issue{where, 0, "flat-…",
                      fmt::format("no light: the brightest level is {:.3g} DN above the dark frames", brightest_dn),
                      "levels of light up to saturation"});
    }
    if (least_saturated > 0.5) {
      throw base::InputError(base::Issue{where, 0, "flat-…",
                                         fmt::format("all levels saturated: {:.0f} % of the darkest one is at code {}",
                                                     100.0 * least_saturated, folder_.largest_code()),
                                         "levels of light from dark to saturation"});
    }
  }

  bool shows_noise(const CellStatistics& all) const {
    const double variance = all.temporal_dn2 - kQuantisation;
    return variance > 0.0 &&
           rounding_of_variance(variance, all.total_dn2 - kQuantisation) <= kRoundingAllowed * variance;
  }

  /// Weight of a point in the line: its sampling error, and the possible effect of rounding on the whole level.
  double weight_of(double sampling_dn4, const CellStatistics& all) const {
    const double rounding =
        rounding_of_variance(std::max(all.temporal_dn2 - kQuantisation, 0.0), all.total_dn2 - kQuantisation);
    return 1.0 / (sampling_dn4 + 0.5 * rounding * rounding);
  }

  void choose_levels() {
    Evidence& all = evidence();
    for (std::size_t level = 0; level < all.flats.size(); ++level) {
      const FlatFieldStack& flat = all.flats[level];
      std::vector<char> counts(flat.cells.size(), 0);
      double pixels = 0.0;
      for (std::size_t c = 0; c < flat.cells.size(); ++c) {
        const CellStatistics& cell = flat.cells[c];
        if (cell.pixels == 0.0 || cell.at_zero > kMostClippedPart || cell.at_largest > kMostClippedPart) continue;
        if (cell.mean_dn - dark().cells[c].mean_dn > kLinearRange * evidence().saturation.level_dn) continue;
        counts[c] = 1;
        pixels += cell.pixels;
      }
      all.counts.push_back(std::move(counts));
      const bool used = pixels >= kLeastShareOfPixels * flat.all.pixels && shows_noise(flat.all);
      all.weight.push_back(used ? weight_of(level_point(all, level, std::nullopt).sampling_dn4, flat.all) : 0.0);
    }
    const CellStatistics& dark_all = dark().all;
    all.read_noise_from_dark = !out_.dark_clipped && shows_noise(dark_all);
    if (!all.read_noise_from_dark) return;
    const double degrees = dark_all.pixels * static_cast<double>(dark().frames - 1);
    all.dark_weight = weight_of(2.0 * dark_all.temporal_dn2 * dark_all.temporal_dn2 / degrees, dark_all);
  }

  void find_middle_level() {
    double nearest = 0.0;
    for (std::size_t level = 0; level < evidence().flats.size(); ++level) {
      if (evidence().weight[level] == 0.0) continue;
      const LevelPoint point = level_point(evidence(), level, std::nullopt);
      const double distance = std::abs(point.mean_dn - 0.5 * evidence().saturation.level_dn);
      if (out_.middle_level && distance >= nearest) continue;
      out_.middle_level = level;
      nearest = distance;
    }
  }

  void measure_patterns() {
    const std::size_t middle = *out_.middle_level;
    const FlatFieldStack flat = stack(folder_.flats[middle]);
    out_.mosaic = has_mosaic(flat, dark());
    find_outliers_in_light(flat.mean_dn - dark().mean_dn);
    evidence().dark_pattern = pattern_of(dark());
    evidence().dark_pattern_shown = evidence().read_noise_from_dark;
    if (evidence().dark_pattern_shown) {
      evidence().pattern_levels = {middle};
      evidence().flat_pattern = {pattern_of(flat)};
      evidence().pattern_weight = {1.0};
      return;
    }
    // Each dark pixel keeps its code, so the mean of the dark frames shows no pattern: the regression over several
    // levels does.
    for (std::size_t level = 0; level < evidence().flats.size(); ++level) {
      if (evidence().weight[level] == 0.0) continue;
      evidence().pattern_levels.push_back(level);
      evidence().flat_pattern.push_back(
          pattern_of(stack_frames(folder_.flats[level], form_, folder_.largest_code(), out_.grid, mask_)));
      double pixels = 0.0;
      double squares = 0.0;
      for (const CellPattern& cell : evidence().flat_pattern.back()) {
        pixels += cell.pixels;
        squares += cell.squares_dn2;
      }
      evidence().pattern_weight.push_back(pixels * pixels / (squares * squares));  // its error is proportional to it
    }
  }

  std::vector<CellPattern> pattern_of(const FlatFieldStack& set) const {
    return spatial_pattern(set.mean_dn, set.contrast_dn, out_.grid, mask_, out_.mosaic);
  }

  void find_outliers_in_light(const cv::Mat& light) {
    const cv::Mat around = neighbourhood_median(light, out_.mosaic);
    cv::Mat answer;
    cv::divide(light, cv::max(around, 1e-3),
               answer);  // a neighbourhood without light carries no information; see the mask below
    const cv::Mat deviation = answer - 1.0;
    const cv::Mat lit = (around > 1e-3) & (mask_ != 0);
    const double limit = kOutlierSd * robust_sd(deviation, lit);
    const cv::Mat outlying = (cv::abs(deviation) > limit) & lit;
    out_.outlying_pixels += static_cast<std::size_t>(cv::countNonZero(outlying));
    out_.dead_pixels = static_cast<std::size_t>(cv::countNonZero((answer < 0.5) & outlying));
    mask_.setTo(0, outlying);
  }

  const FlatFieldFolder& folder_;
  const base::Progress& progress_;
  CameraEvidence out_;
  FrameForm form_;
  cv::Mat mask_;
  int steps_ = 0;
};

}  // namespace

CameraEvidence gather_evidence(const FlatFieldFolder& folder, const base::Progress& progress) {
  return Gatherer(folder, progress).gather();
}

}  // namespace glidelab::core
