#include "core/pictures/board/board_views.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <optional>

#include "base/errors.h"
#include "base/long_work.h"
#include "core/math/quantile.h"
#include "core/pictures/frames/read_image.h"

namespace glidelab::core {
namespace fs = std::filesystem;

namespace {

constexpr std::size_t kFewestViews = 3;  // two give no more than the focal length
constexpr double kOutlierPx = 0.2;       // of a view's corners, rms
constexpr double kOutlierRatio = 5.0;    // over the median of the views

}  // namespace

std::string names_of(const std::vector<fs::path>& files) {
  std::vector<std::string> names;
  for (const fs::path& file : files) names.push_back(file.filename().string());
  return fmt::format("{}", fmt::join(names, ", "));
}

std::vector<cv::Point3d> pattern_points(cv::Size grid, double square_m) {
  std::vector<cv::Point3d> points;
  for (int j = 0; j < grid.height; ++j) {
    for (int i = 0; i < grid.width; ++i) points.emplace_back(i * square_m, j * square_m, 0.0);
  }
  return points;
}

BoardViews find_board_views(const std::vector<fs::path>& files, cv::Size inner_corners, int jobs,
                            std::size_t most_pixels, const base::Progress& progress) {
  const GreyReader read = [most_pixels](const fs::path& file) { return read_grey_image(file, most_pixels); };
  return find_board_views(files, inner_corners, jobs, read, progress);
}

BoardViews find_board_views(const std::vector<fs::path>& files, cv::Size inner_corners, int jobs,
                            const GreyReader& read, const base::Progress& progress) {
  std::vector<fs::path> unique;
  for (const fs::path& file : files) {
    if (std::find(unique.begin(), unique.end(), file) == unique.end()) unique.push_back(file);
  }
  std::vector<std::optional<BoardCorners>> corners(unique.size());
  std::vector<cv::Size> sizes(unique.size());
  std::vector<std::optional<BoardImage>> images(unique.size());
  std::atomic<std::size_t> done = 0;
  const auto tell = [&] { progress("pattern", static_cast<double>(done.load()) / static_cast<double>(unique.size())); };
  base::for_each_parallel(unique.size(), jobs, [&](std::size_t i) {
    tell();
    const cv::Mat grey = read(unique[i]);
    sizes[i] = grey.size();
    const std::vector<cv::Point2f> seen = search_board(grey, inner_corners, BoardDetector::any, tell);
    if (!seen.empty()) images[i] = cut_board(grey, orient_board(grey, inner_corners, seen));
    ++done;
  });
  // One camera took them all.
  std::vector<BoardImage> with_board;
  for (const std::optional<BoardImage>& image : images) {
    if (image) with_board.push_back(*image);
  }
  const std::optional<EdgeResponse> response = board_response(with_board);
  base::for_each_parallel(unique.size(), jobs, [&](std::size_t i) {
    tell();
    if (images[i]) corners[i] = refine_board(*images[i], response);
  });
  BoardViews found;
  for (std::size_t i = 0; i < unique.size(); ++i) {
    if (i == 0) found.image_size = sizes[0];
    if (sizes[i] != found.image_size) {
      throw base::InputError(base::Issue{unique[i].string(), 0, "",
                                         fmt::format("{} x {} pixels", sizes[i].width, sizes[i].height),
                                         fmt::format("{} x {} pixels, as {}", found.image_size.width,
                                                     found.image_size.height, unique[0].filename().string())});
    }
    if (corners[i]) {
      found.views.push_back({unique[i], std::move(*corners[i])});
    } else {
      found.without.push_back(unique[i]);
    }
  }
  return found;
}

std::vector<const BoardView*> checked_views(const BoardViews& boards) {
  if (boards.views.size() < kFewestViews) {
    const fs::path any =
        boards.views.empty() ? boards.without.empty() ? fs::path() : boards.without.front() : boards.views.front().file;
    throw base::InputError(
        base::Issue{any.parent_path().string(), 0, "calibration.views",
                    fmt::format("{} images with a visible pattern{}", boards.views.size(),
                                boards.without.empty() ? "" : fmt::format(" (none in {})", names_of(boards.without))),
                    "at least 3, with all inner corners in sight"});
  }
  std::vector<const BoardView*> views;
  for (const BoardView& view : boards.views) views.push_back(&view);
  return views;
}

KeptViews without_outliers(const std::vector<const BoardView*>& views, const std::vector<double>& errors_px) {
  const double limit_px = std::max(kOutlierPx, kOutlierRatio * median_of(errors_px));
  const auto off =
      std::count_if(errors_px.begin(), errors_px.end(), [&](double error) { return !(error <= limit_px); });
  const bool enough = views.size() - static_cast<std::size_t>(off) >= kFewestViews;
  KeptViews kept;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const bool is_off = !(errors_px[i] <= limit_px);
    if (!is_off || !enough) kept.views.push_back(views[i]);
    if (!is_off) continue;
    kept.notes.emplace_back(OutlyingView{views[i]->file.filename().string(), errors_px[i], enough});
  }
  return kept;
}

}  // namespace glidelab::core
