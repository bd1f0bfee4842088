/// The camera's calibration and the marker's fit on their own, from images in memory. Pixels are read in numpy's
/// memory.
#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <string_view>
#include <utility>

#include "base/errors.h"
#include "core/pictures/board/board_views.h"
#include "core/pictures/board/chessboard.h"
#include "core/pictures/camera/calibrate.h"
#include "core/pictures/marker/marker_fit.h"
#include "python/binding/bindings.h"
#include "python/binding/given_input.h"
#include "python/binding/watched_work.h"
#include "report/analysis/note_words.h"

namespace glidelab::python {

namespace py = pybind11;

namespace {

/// A grey image, one channel, without a copy; it lives as long as the array.
cv::Mat image_of(const py::array& pixels, const std::string& name) {
  const bool bytes = py::isinstance<py::array_t<std::uint8_t>>(pixels);
  const bool words = py::isinstance<py::array_t<std::uint16_t>>(pixels);
  if (pixels.ndim() != 2 || !(bytes || words) || !(pixels.flags() & py::array::c_style)) {
    throw base::InputError(base::Issue{"", 0, name,
                                       fmt::format("an array of {} dimensions and type {}", pixels.ndim(),
                                                   py::str(pixels.dtype()).cast<std::string>()),
                                       "a grey image: two dimensions, contiguous, uint8 or uint16"});
  }
  return cv::Mat(static_cast<int>(pixels.shape(0)), static_cast<int>(pixels.shape(1)), bytes ? CV_8U : CV_16U,
                 const_cast<void*>(pixels.data()));
}

core::BoardViews views_of(const std::vector<cv::Mat>& images, cv::Size inner_corners, int jobs,
                          const base::Progress& progress) {
  std::vector<std::filesystem::path> names;
  std::map<std::filesystem::path, cv::Mat> named;
  for (const cv::Mat& image : images) {
    names.emplace_back(fmt::format("images[{}]", names.size()));
    named[names.back()] = image;
  }
  const core::GreyReader read = [&](const std::filesystem::path& name) { return named.at(name); };
  const base::Progress told = [&](std::string_view, double part) { progress("finding the pattern", part); };
  return core::find_board_views(names, inner_corners, jobs, read, told);
}

py::dict as_dict(const core::Calibration& calibration) {
  const core::CameraModel& camera = calibration.camera;
  const bool fisheye = camera.lens == core::LensKind::fisheye;
  const std::size_t terms = fisheye ? 4 : 5;
  std::vector<double> sd;
  for (std::size_t i = 0; i < 4 + terms; ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    sd.push_back(std::sqrt(calibration.covariance(at, at)));
  }
  py::dict found;
  found["lens"] = fisheye ? "fisheye" : "brown-conrady";
  found["focal_px"] = py::make_tuple(camera.fx, camera.fy);
  found["centre_px"] = py::make_tuple(camera.cx, camera.cy);
  found["distortion"] = vector_of({camera.distortion.data(), terms});
  found["sd"] = vector_of(sd);
  found["size_px"] = py::make_tuple(camera.size.width, camera.size.height);
  found["rms_px"] = calibration.rms_px;
  found["model"] = report::lens_words(calibration.lens);
  found["views_used"] = calibration.views_used;
  found["notes"] = report::notes_words(calibration.notes);
  return found;
}

void check_board(int columns, int rows, double square_m) {
  constexpr int kFewest = 2;
  if (columns < kFewest || rows < kFewest) {
    throw base::InputError(base::Issue{"", 0, "inner_corners", fmt::format("{} x {}", columns, rows),
                                       "two numbers of inner corners, 2 or more each"});
  }
  if (!(std::isfinite(square_m) && square_m > 0.0)) {
    throw base::InputError(base::Issue{"", 0, "square_m", fmt::format("{}", square_m), "a length in metres above 0"});
  }
}

py::dict calibrate_images(const std::vector<py::array>& arrays, std::pair<int, int> inner_corners, double square_m,
                          int jobs, const py::object& told) {
  check_board(inner_corners.first, inner_corners.second, square_m);
  std::vector<cv::Mat> images;
  for (std::size_t i = 0; i < arrays.size(); ++i) images.push_back(image_of(arrays[i], fmt::format("images[{}]", i)));
  return as_dict(WatchedWork(told).run([&](const base::Progress& progress) {
    const core::BoardViews views = views_of(images, {inner_corners.first, inner_corners.second}, jobs, progress);
    core::checked_views(views);
    progress("fitting the camera", 0.0);
    return core::calibrate_any_lens(views, square_m);
  }));
}

py::dict calibrate_files(const std::vector<std::string>& files, std::pair<int, int> inner_corners, double square_m,
                         int jobs, const py::object& told) {
  check_board(inner_corners.first, inner_corners.second, square_m);
  return as_dict(WatchedWork(told).run([&](const base::Progress& progress) {
    const core::BoardViews views = core::find_board_views(
        {files.begin(), files.end()}, {inner_corners.first, inner_corners.second}, jobs, core::kMostPixels, progress);
    core::checked_views(views);
    progress("fitting the camera", 0.0);
    return core::calibrate_any_lens(views, square_m);
  }));
}

/// A separate image: the caller's pixels stay unchanged.
cv::Mat inverse_of(const cv::Mat& grey) {
  cv::Mat inverse;
  cv::bitwise_not(grey, inverse);
  return inverse;
}

py::object fit_marker(const py::array& pixels, double u_px, double v_px, double radius_px, bool shaded, bool dark) {
  if (!(std::isfinite(u_px) && std::isfinite(v_px) && std::isfinite(radius_px) && radius_px > 0.0)) {
    throw base::InputError(
        base::Issue{"", 0, "radius_px", fmt::format("{}", radius_px), "a radius above 0, and a centre, in pixels"});
  }
  core::Signal signal{image_of(pixels, "image")};
  std::optional<core::MarkerFit> fit;
  {
    const py::gil_scoped_release without_lock;
    if (dark) signal.values = inverse_of(signal.values);
    core::MarkerGuess guess;
    guess.centre = {u_px, v_px};
    guess.radius_px = radius_px;
    fit = core::fit_marker(signal, guess, shaded ? core::Surface::shaded : core::Surface::uniform);
  }
  if (!fit) return py::none();
  return py::make_tuple(fit->centre.x, fit->centre.y, fit->sd_px, fit->radius_px, fit->elongation, fit->amplitude,
                        fit->background, fit->blur_px, fit->rms);
}

}  // namespace

void bind_camera(py::module_& module) {
  module.def("calibrate_images", &calibrate_images);
  module.def("calibrate_files", &calibrate_files);
  module.def("fit_marker", &fit_marker);
}

}  // namespace glidelab::python
