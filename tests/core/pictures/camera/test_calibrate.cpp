#include "core/pictures/camera/calibrate.h"

#include <Eigen/Core>

#include <cmath>
#include <opencv2/imgcodecs.hpp>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "core/experiment/file_names.h"
#include "tests/catch.h"
#include "tests/core/known_camera.h"
#include "tests/core/notes.h"
#include "tests/core/painter.h"
#include "tests/core/real_data.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using tests::KnownCamera;

TEST_CASE("undoing the distortion is the inverse of distorting, to 1e-9 px over the whole image") {
  const core::CameraModel model{830.0, 828.0, 403.7, 296.2, {-0.21, 0.07, 4e-4, -3e-4, 0.01}, {800, 600}};
  for (int v = 0; v < 600; v += 50) {
    for (int u = 0; u < 800; u += 50) {
      const auto normalised = model.to_normalised(cv::Point2d(u, v));
      REQUIRE(normalised);
      CHECK(cv::norm(model.to_pixel(*normalised) - cv::Point2d(u, v)) < 1e-9);
    }
  }
}

TEST_CASE("the camera model projects as an independent implementation does") {
  const KnownCamera known{.k3 = 0.02};
  const core::CameraModel model{
      known.fx, known.fy, known.cx, known.cy, {known.k1, known.k2, known.p1, known.p2, known.k3}, known.size};
  for (double x = -0.45; x < 0.5; x += 0.15) {
    for (double y = -0.35; y < 0.4; y += 0.1) {
      CHECK(cv::norm(model.to_pixel({x, y}) - known.project({2.0 * x, 2.0 * y, 2.0})) < 1e-10);
    }
  }
}

TEST_CASE("a pixel beyond the fold of a strong barrel distortion has no ray") {
  // x (1 - 0.5 x^2) has its largest value, 0.544, at x = sqrt(2/3): 0.544 * 500 = 272 px from the axis.
  const core::CameraModel model{500.0, 500.0, 400.0, 300.0, {-0.5, 0.0, 0.0, 0.0, 0.0}, {800, 600}};
  CHECK(model.to_normalised({400.0 + 265.0, 300.0}));
  CHECK_FALSE(model.to_normalised({400.0 + 280.0, 300.0}));
}

TEST_CASE("a known camera is recovered from noisy corners within its stated uncertainty") {
  const KnownCamera known;
  cv::RNG random(11);
  const double noise_px = 0.01;
  const core::Calibration calibration = core::calibrate_camera(tests::known_views(known, noise_px, random), 0.04);
  CHECK(calibration.views_used == 12);
  // The rms distance of a two-dimensional error with sd 0.01 in each coordinate, over 648 corners: 0.01 sqrt(2) +- 2 %.
  CHECK(std::abs(calibration.rms_px / (noise_px * std::sqrt(2.0)) - 1.0) < 0.08);
  const double truth[] = {known.fx, known.fy, known.cx, known.cy, known.k1, known.k2, known.p1, known.p2, known.k3};
  const core::CameraModel& camera = calibration.camera;
  const double value[] = {camera.fx,
                          camera.fy,
                          camera.cx,
                          camera.cy,
                          camera.distortion[0],
                          camera.distortion[1],
                          camera.distortion[2],
                          camera.distortion[3],
                          camera.distortion[4]};
  for (int i = 0; i < 9; ++i) {
    const double sd = std::sqrt(calibration.covariance(i, i));
    INFO("term " << i << ": " << value[i] << " sd " << sd << ", truth " << truth[i]);
    // 4 sd: one in 2000 by chance over nine terms.
    CHECK(std::abs(value[i] - truth[i]) <= 4.0 * sd);
  }
  // 648 corners at 0.01 px over lever arms of 300 px leave the focal length to some hundredths of a pixel.
  CHECK(std::sqrt(calibration.covariance(0, 0)) < 0.2);
}

TEST_CASE("terms that the views do not determine are fixed to zero, and the model says which are left") {
  KnownCamera known;
  known.p1 = known.p2 = known.k3 = 0.0;
  cv::RNG random(3);
  const core::Calibration calibration = core::calibrate_camera(tests::known_views(known, 0.05, random), 0.04);
  CHECK(calibration.camera.distortion[2] == 0.0);
  CHECK(calibration.camera.distortion[3] == 0.0);
  CHECK(calibration.camera.distortion[4] == 0.0);
  CHECK(calibration.lens.kept == std::vector<std::string>{"k1", "k2"});
}

TEST_CASE("a pair that the views do not support is left out beside a high term that they do") {
  KnownCamera known{.k3 = 0.05};
  known.p1 = known.p2 = 0.0;
  cv::RNG random(3);
  const core::Calibration calibration = core::calibrate_camera(tests::known_views(known, 0.02, random), 0.04);
  // k3 of 0.02 has two to three standard deviations at 0.1 px; this one some thirty.
  CHECK(calibration.camera.distortion[4] != 0.0);
  CHECK(calibration.camera.distortion[2] == 0.0);
  CHECK(calibration.camera.distortion[3] == 0.0);
}

TEST_CASE("a lens without distortion gets no term of it") {
  KnownCamera known;
  known.k1 = known.k2 = known.p1 = known.p2 = known.k3 = 0.0;
  cv::RNG random(4);
  const core::Calibration calibration = core::calibrate_camera(tests::known_views(known, 0.05, random), 0.04);
  for (const double term : calibration.camera.distortion) CHECK(term == 0.0);
  CHECK(calibration.lens.kept.empty());
  const double sd_fx = std::sqrt(calibration.covariance(0, 0));
  CHECK(std::abs(calibration.camera.fx - known.fx) <= 4.0 * sd_fx);
}

TEST_CASE("a term that is there but hardly seen is left out, and what it may do stays in the uncertainty") {
  // k3 of two to three of its standard deviations: left out in most draws; then the others take it up, and are off.
  KnownCamera known;
  known.p1 = known.p2 = 0.0;
  cv::RNG random(6);
  int left_out = 0, within = 0, draws = 0;
  double squares = 0.0;  // of the errors of k1 where k3 is left out, over what is said of them
  for (; draws < 12; ++draws) {
    KnownCamera with = known;
    with.k3 = 0.02;
    const core::Calibration calibration = core::calibrate_camera(tests::known_views(with, 0.1, random), 0.04);
    const double sd = std::sqrt(calibration.covariance(4, 4));
    if (calibration.camera.distortion[4] == 0.0) {
      ++left_out;
      squares += std::pow((calibration.camera.distortion[0] - with.k1) / sd, 2);
    }
    within += std::abs(calibration.camera.distortion[0] - with.k1) < 3.0 * sd;
  }
  CHECK(left_out >= 1);
  // The mean of `left_out` squares of standard normal numbers, 11 of them or so, is 1 with a standard deviation of
  // 0.43.
  CHECK(squares < 1.85 * left_out);
  CHECK(within >= 11);  // 3 standard deviations; a pre-test's distribution has longer tails than a normal one
}

namespace {

/// Seen through a long image's middle third only, so that nothing but chance says what a high term does at its sides.
core::BoardViews views_of_the_middle(const KnownCamera& camera, cv::RNG& random) {
  core::BoardViews boards;
  boards.image_size = camera.size;
  for (int k = 0; k < 8; ++k) {
    const cv::Vec3d middle(0.05 * (k % 4 - 1.5), 0.03 * (k / 4) - 0.015, 1.35);
    const auto plane =
        tests::known_plane(middle, 0.4 * (k % 3 - 1), 0.35 * ((k + 1) % 3 - 1), 0.1 * (k % 2), 0.16, 0.1);
    boards.views.push_back(
        {"view-" + std::to_string(k) + ".png", tests::known_corners(camera, plane, 0.04, 0.02, random)});
  }
  return boards;
}

}  // namespace

TEST_CASE("noise that looks like a high term where the pattern was seen does not bend the image's sides") {
  const KnownCamera known{800.0, 800.0, 319.5, 119.5, -0.055, 0.0, 0.0, 0.0, 0.0, {640, 240}};
  cv::RNG random(585);  // of 600 draws the one in which k3 has more than three of its standard deviations
  const core::Calibration calibration = core::calibrate_camera(views_of_the_middle(known, random), 0.04);
  for (const double x : {-0.39, 0.39}) {
    const auto found = calibration.camera.to_normalised(known.project({x, 0.0, 1.0}));
    REQUIRE(found);
    INFO(fmt::format("{}", fmt::join(calibration.lens.kept, ", ")) << ", at " << x << " found " << found->x);
    // k1 is known to 0.02 or so: 0.02 x^3 is 0.0012.
    CHECK(std::abs(found->x - x) < 0.004);
  }
}

namespace {

/// How far the camera errs along x where it sees this ray, in units of the stated standard deviation.
double error_along_x(const KnownCamera& known, const core::Calibration& calibration, cv::Vec3d ray) {
  const cv::Point2d pixel = known.project(ray);
  const auto along_x = [&](const core::CameraModel& camera) {
    const auto found = camera.to_normalised(pixel);
    REQUIRE(found);
    return found->x;
  };
  Eigen::Matrix<double, 9, 1> derivative;
  for (Eigen::Index k = 0; k < 9; ++k) {
    const double step = k < 4 ? 1e-3 : 1e-7;
    Eigen::Matrix<double, 9, 1> change = Eigen::Matrix<double, 9, 1>::Zero();
    change[k] = step;
    const double up = along_x(calibration.camera.moved(change)), down = along_x(calibration.camera.moved(-change));
    derivative[k] = 0.5 * (up - down) / step;
  }
  const double sd = std::sqrt(derivative.dot(calibration.covariance * derivative));
  return (along_x(calibration.camera) - ray[0]) / sd;
}

}  // namespace

TEST_CASE("over lenses from straight to strongly curved, a ray errs as much as is stated") {
  // High terms are as large as their lens's k1 at the corner, more or less, as those of measured lenses are.
  constexpr int kLenses = 60;
  cv::RNG random(31);
  double all = 0.0, middle = 0.0;  // squares, of views that fill the image and of those that fill its middle third
  for (int k = 0; k < kLenses; ++k) {
    KnownCamera known;
    const double r2 = 0.36, extent = std::pow(10.0, random.uniform(-4.0, -1.0));  // at the corner
    known.k1 = (k % 2 == 0 ? extent : -extent) / r2;
    known.k2 = random.gaussian(extent) / (r2 * r2);
    known.k3 = random.gaussian(0.3 * extent) / (r2 * r2 * r2);
    known.p1 = random.gaussian(5e-4);
    known.p2 = random.gaussian(5e-4);
    const core::BoardViews boards = tests::known_views(known, 0.05, random);
    all += std::pow(error_along_x(known, core::calibrate_camera(boards, 0.04), {0.38, 0.28, 1.0}), 2) / kLenses;
    known.cx = 319.5;
    known.cy = 119.5;
    known.size = {640, 240};
    const core::BoardViews few = views_of_the_middle(known, random);
    middle += std::pow(error_along_x(known, core::calibrate_camera(few, 0.04), {0.3, 0.0, 1.0}), 2) / kLenses;
  }
  // The root mean square of 60 standard normal numbers is 1 with a standard deviation of 0.09; the lenses' terms follow
  // another distribution than calibrate_camera() assumes, which may take a third more.
  for (const double squares : {all, middle}) {
    CHECK(std::sqrt(squares) > 0.65);
    CHECK(std::sqrt(squares) < 1.35);
  }
}

TEST_CASE("a view that contradicts the others is left out with a note") {
  const KnownCamera known;
  cv::RNG random(5);
  core::BoardViews boards = tests::known_views(known, 0.01, random);
  for (std::size_t i = 0; i < 54; i += 2) boards.views[4].corners.points[i].x += 3.0;
  const core::Calibration calibration = core::calibrate_camera(boards, 0.04);
  CHECK(calibration.views_used == 11);
  CHECK(calibration.rms_px < 0.02);
  const auto* const outlying = tests::note_of<core::OutlyingView>(calibration.notes);
  REQUIRE(outlying != nullptr);
  CHECK(outlying->file == "view-4.png");
  CHECK(outlying->left_out);
}

TEST_CASE("fewer than three views with a visible pattern are an error that names the others") {
  const KnownCamera known;
  cv::RNG random(5);
  core::BoardViews boards = tests::known_views(known, 0.01, random);
  boards.views.resize(2);
  boards.without = {"calibration/view-07.png"};
  CHECK_THROWS_WITH(core::calibrate_camera(boards, 0.04),
                    Catch::Contains("2 images with a visible pattern") && Catch::Contains("view-07.png"));
}

TEST_CASE("images without any visible pattern are an error that names them") {
  const tests::TempDir dir;
  std::vector<std::filesystem::path> files;
  for (const char* name : {"view-00.png", "view-01.png", "view-02.png", "view-03.png"}) {
    files.push_back(dir / name);
    cv::imwrite(files.back().string(), cv::Mat(120, 160, CV_8U, cv::Scalar(90)));
  }
  const core::BoardViews boards = core::find_board_views(files, {9, 6}, 2);
  CHECK(boards.views.empty());
  CHECK_THROWS_WITH(core::calibrate_camera(boards, 0.04),
                    Catch::Contains("calibration.views") && Catch::Contains("0 images with a visible pattern") &&
                        Catch::Contains("view-00.png") && Catch::Contains("view-03.png"));
}

TEST_CASE("files that are not images, or of another size, are errors that name the file") {
  const tests::TempDir dir;
  cv::imwrite((dir / "a.png").string(), cv::Mat(120, 160, CV_8U, cv::Scalar(90)));
  cv::imwrite((dir / "b.png").string(), cv::Mat(120, 100, CV_8U, cv::Scalar(90)));
  base::write_file(dir / "text.png", "this is no picture");
  base::write_file(dir / "empty.png", "");
  const auto find = [&](const char* second) { core::find_board_views({dir / "a.png", dir / second}, {9, 6}, 2); };
  CHECK_THROWS_WITH(find("b.png"), Catch::Contains("b.png") && Catch::Contains("100 x 120"));
  CHECK_THROWS_WITH(find("text.png"), Catch::Contains("text.png") && Catch::Contains("no image"));
  CHECK_THROWS_WITH(find("empty.png"), Catch::Contains("empty.png"));
  CHECK_THROWS_AS(find("empty.png"), base::InputError);
}

TEST_CASE("an action camera's real chessboard views calibrate to half a pixel") {
  const auto folder = tests::real_data("chessboard-barrel");
  if (!folder) return;
  const core::BoardViews boards = core::find_board_views(core::files_matching(*folder, "*.jpg"), {8, 6}, 2);
  const core::Calibration calibration = core::calibrate_camera(boards, 0.03);
  INFO("rms " << calibration.rms_px << " px, fx " << calibration.camera.fx << ", k1 "
              << calibration.camera.distortion[0] << ", " << calibration.views_used << " views");
  // The folder's README: an independent fit of 36 views of the same camera gave rms 0.52 px, 560 px, k1 = -0.233; 12
  // views and one more or fewer term move the last two by a few per cent.
  CHECK(calibration.views_used >= 11);
  CHECK(calibration.rms_px < 0.6);
  CHECK(std::abs(calibration.camera.fx - 560.0) < 15.0);
  CHECK(std::abs(calibration.camera.distortion[0] + 0.233) < 0.03);
}
