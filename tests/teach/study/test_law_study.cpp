#include "teach/study/law_study.h"

#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <set>
#include <tuple>

#include "base/files/file_io.h"
#include "sim/force/law_list.h"
#include "sim/oracle/closed_forms.h"
#include "test_paths.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;

namespace {

teach::LawStudy study(const std::string& name) {
  return teach::study_law(std::filesystem::path(tests::kSourceDir) / "scenarios/laws" / (name + ".toml"));
}

}  // namespace

TEST_CASE("Every teaching scenario is a whole scenario, and its motions run on its curves") {
  std::size_t count = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(tests::kSourceDir) / "scenarios/laws")) {
    INFO(entry.path().filename().string());
    const teach::LawStudy found = teach::study_law(entry.path());
    CHECK_FALSE(found.text.empty());
    CHECK_FALSE(found.motions.empty());
    for (const teach::LawMotion& motion : found.motions) {
      CHECK(motion.x_m.size() == motion.t_s.size());
      const auto [low, high] = std::minmax_element(motion.x_m.begin(), motion.x_m.end());
      CHECK(*low > -1.0);  // on the 2 m track
      CHECK(*high < 1.0);
    }
    ++count;
  }
  CHECK(count == 8);
}

TEST_CASE("Launched up, from rest and too fast, the viscous glider tends to the v_lim of equation (4)") {
  const teach::LawStudy found = study("1-viscous");
  const double v_lim = 9.80665 * std::sin(4.311 * std::acos(-1.0) / 180.0) / 2.768;
  REQUIRE(found.curves.size() == 2);
  REQUIRE(found.curves[0].equilibria.size() == 1);
  CHECK(found.curves[0].equilibria[0].v_m_s == 0.0);
  REQUIRE(found.curves[1].equilibria.size() == 1);
  CHECK(std::abs(found.curves[1].equilibria[0].v_m_s - v_lim) < 1e-12);
  std::set<int> starts;
  for (const std::size_t m : found.curves[1].motions) {
    const teach::LawMotion& motion = found.motions[m];
    starts.insert(motion.v_m_s.front() < 0.0 ? -1 : motion.v_m_s.front() > v_lim ? 2 : 0);
    // What is left of the start after the clip: e^(-K t / m) of it.
    const double left = std::abs(motion.v_m_s.front() - v_lim) * std::exp(-2.768 * motion.t_s.back());
    CHECK(std::abs(std::abs(motion.v_m_s.back() - v_lim) - left) < 1e-9);
  }
  CHECK(starts == std::set<int>{-1, 0, 2});
}

TEST_CASE("The look-alikes are a millimetre apart in x and a quarter m/s2 and more in a") {
  const teach::LawStudy found = study("8-look-alike");
  REQUIRE(found.x_apart_m);
  // The fit of the second law's parameters to the first one's x(t) leaves 1.0 mm.
  CHECK(*found.x_apart_m < 1.1e-3);
  // At v -> 0 the one has no friction, the other mu g = 0.294 m/s2.
  CHECK(std::abs(*found.a_apart_m_s2 - 0.030003 * 9.80665) < 1e-3);
}

TEST_CASE("Stribeck's slow glider sticks below an unstable equilibrium, the faster ones tend to the one beyond it") {
  const teach::LawStudy found = study("6-stribeck");
  REQUIRE(found.curves.size() == 2);
  const teach::LawCurve& inclined = found.curves[1];
  REQUIRE(inclined.equilibria.size() == 3);
  const auto [rest, edge, limit] = std::tuple(inclined.equilibria[0], inclined.equilibria[1], inclined.equilibria[2]);
  // a(v) of the file's numbers.
  const double alpha = 2.0 * std::acos(-1.0) / 180.0;
  const auto a = [&](double v) {
    const double friction = 0.02 * (1.0 + 2.0 * std::exp(-std::pow(v / 0.15, 2)));
    return 9.80665 * (std::sin(alpha) - friction * std::cos(alpha)) - 0.3 * v;
  };
  CHECK(rest.v_m_s == 0.0);
  CHECK((rest.stable && rest.stops));
  CHECK_FALSE(edge.stable);
  CHECK(limit.stable);
  for (const double v : {edge.v_m_s, limit.v_m_s}) CHECK(std::abs(a(v)) < 1e-14);
  CHECK((a(edge.v_m_s - 0.01) < 0.0 && a(edge.v_m_s + 0.01) > 0.0 && a(limit.v_m_s + 0.01) < 0.0));
  for (const std::size_t m : inclined.motions) {
    const std::vector<double>& v = found.motions[m].v_m_s;
    INFO(found.motions[m].clip);
    if (v.front() < edge.v_m_s) {
      CHECK(v.back() == 0.0);
    } else {
      CHECK(std::abs(v.back() - limit.v_m_s) < 0.5 * std::abs(v.front() - limit.v_m_s));
    }
  }
}

TEST_CASE("The eddy-current brake holds up to the second zero of a(v), and nothing beyond it") {
  const teach::LawStudy found = study("7-eddy-rolloff");
  // g sin(alpha) (1 + (v / v_c)²) = k v has two roots.
  const double drive = 9.80665 * std::sin(4.311 * std::acos(-1.0) / 180.0), k = 2.768, v_c = 0.6;
  const double root = std::sqrt(k * k - std::pow(2.0 * drive / v_c, 2)), twice = 2.0 * drive / (v_c * v_c);
  REQUIRE(found.curves[1].equilibria.size() == 2);
  const teach::Equilibrium held = found.curves[1].equilibria[0], lost = found.curves[1].equilibria[1];
  CHECK(held.stable);
  CHECK_FALSE(lost.stable);
  CHECK(std::abs(held.v_m_s - (k - root) / twice) < 1e-14);
  CHECK(std::abs(lost.v_m_s - (k + root) / twice) < 1e-13);
}

TEST_CASE("Only friction brings a glider to rest: with a drag alone it tends there, with nothing it goes on") {
  const auto on_the_level = [](std::shared_ptr<const sim::ForceTerm> force) {
    sim::Body body{0.3, 0.0, 9.80665, {}};
    if (force) body.forces.push_back(std::move(force));
    return teach::equilibria(body, -1.0, 1.0);
  };
  CHECK(on_the_level(nullptr).empty());
  for (const auto& drag : std::vector<std::shared_ptr<const sim::ForceTerm>>{
           sim::laws::viscous().with({0.5}), sim::laws::quadratic().with({0.5}),
           sim::laws::eddy_rolloff().with({0.5, 0.6}), sim::laws::power_law().with({0.5, 1.5})}) {
    INFO("force at 1 m/s " << drag->force_n(1.0, +1, sim::Contact{0.3, 3.0}) << " N");
    const auto found = on_the_level(drag);
    REQUIRE(found.size() == 1);
    CHECK((found[0].v_m_s == 0.0 && found[0].stable && !found[0].stops));
  }
  for (const auto& friction : std::vector<std::shared_ptr<const sim::ForceTerm>>{
           sim::laws::coulomb().with({0.01}), sim::laws::stribeck().with({0.01, 2.0, 0.1}),
           sim::laws::power_law().with({0.5, 0.5})}) {  // the last stops at 2 sqrt(v0) / k
    INFO("force at 1 m/s " << friction->force_n(1.0, +1, sim::Contact{0.3, 3.0}) << " N");
    const auto found = on_the_level(friction);
    REQUIRE(found.size() == 1);
    CHECK((found[0].v_m_s == 0.0 && found[0].stable && found[0].stops));
  }
}

namespace {

/// The middle along the row of the white pixels about a place, and their number. The window is lower than the marker,
/// and than the distance from it to the glider's magnets.
struct Seen {
  double u_px = 0.0;
  int pixels = 0;
};

Seen white_about(const cv::Mat& image, double u, double v) {
  const cv::Rect window(static_cast<int>(std::lround(u)) - 12, static_cast<int>(std::lround(v)) - 2, 25, 5);
  Seen seen;
  for (int y = window.y; y < window.y + window.height; ++y) {
    for (int x = window.x; x < window.x + window.width; ++x) {
      if (image.at<unsigned char>(y, x) < 220) continue;
      seen.u_px += x;
      ++seen.pixels;
    }
  }
  seen.u_px /= seen.pixels;
  return seen;
}

}  // namespace

TEST_CASE("A law's film is small, and in each of its rows the marker is where equation (2) has it") {
  const auto file = std::filesystem::path(tests::kSourceDir) / "scenarios/laws/1-viscous.toml";
  const teach::LawFilm film = teach::film_law(file);
  CHECK(film.mp4.size() < 200'000);
  // The level and the inclined motions of the file: x0, v0, duration.
  const double k = 2.768, alpha = 4.311 * std::acos(-1.0) / 180.0, v_lim = 9.80665 * std::sin(alpha) / k;
  struct Motion {
    double x0, v0, duration_s, alpha, v_lim;
  };
  const std::vector<Motion> motions = {{-0.4, 1.6, 1.6, 0.0, 0.0},
                                       {0.4, -1.6, 1.6, 0.0, 0.0},
                                       {0.1, -1.3, 2.0, alpha, v_lim},
                                       {-0.3, 0.0, 2.0, alpha, v_lim},
                                       {-0.5, 1.2, 2.0, alpha, v_lim}};
  REQUIRE(film.clips.size() == motions.size());
  CHECK(film.clips[0] == "level-down");
  CHECK(film.frames == 51);  // 2 s at 25 a second, with both ends
  const tests::TempDir temp;
  base::write_file(temp / "film.mp4", film.mp4);
  cv::VideoCapture video((temp / "film.mp4").string());
  REQUIRE(video.isOpened());
  cv::Mat image, grey;
  std::size_t k_frame = 0;
  for (; video.read(image); ++k_frame) {
    cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
    REQUIRE(grey.size() == cv::Size(film.width_px, film.height_px));
    const int height = grey.rows / static_cast<int>(motions.size());
    for (std::size_t i = 0; i < motions.size(); ++i) {
      const Motion& m = motions[i];
      const double t = std::min(static_cast<double>(k_frame) / film.frame_rate_hz, m.duration_s);
      const double x = sim::viscous_motion(k, m.v_lim, m.x0, m.v0, t).x_m;
      // Half the width is half the track and 0.1 m, and the marker is on the line of motion.
      const double px_m = 0.5 * film.width_px / 1.1;
      const double u = 0.5 * (film.width_px - 1) + px_m * x * std::cos(m.alpha);
      const double v = (static_cast<double>(i) + 0.5) * height - 0.5 + px_m * x * std::sin(m.alpha);
      INFO("frame " << k_frame << ", row " << i);
      const Seen marker = white_about(grey, u, v);
      // A disc of 7 px: more than half of 5 lines of it, and its middle to half a pixel in an encoded image.
      CHECK(marker.pixels > 15);
      CHECK(std::abs(marker.u_px - u) < 0.8);
    }
  }
  CHECK(k_frame == film.frames);
}
