#include "render/film/truth_files.h"

#include <fmt/format.h>
#include <Eigen/Eigenvalues>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "base/long_work.h"
#include "base/math/angles.h"
#include "base/text/csv.h"
#include "base/text/json_text.h"
#include "base/toml/toml_set.h"
#include "render/film/clip_renderer.h"
#include "render/scenario/clip_motion.h"
#include "render/scenario/scenario_sections.h"
#include "render/scenario/scene.h"
#include "render/video/video_writer.h"
#include "sim/motion/motion_scenario.h"

namespace glidelab::render {
namespace {

/// A TOML float with a decimal point; 12 digits hide the rounding of a conversion from degrees and back.
std::string number(double value) {
  std::string text = fmt::format("{:.12g}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

const char* word_of(sim::Launched launched) {
  return launched == sim::Launched::up ? "up" : launched == sim::Launched::down ? "down" : "released";
}

nlohmann::ordered_json maybe(const std::optional<double>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

// Gauss-Legendre on [0, 1] with 8 points: exact up to degree 15. Nodes and weights of [-1, 1] from Abramowitz and
// Stegun, table 25.4.
constexpr std::array<double, 4> kNodes = {0.183434642495649805, 0.525532409916328986, 0.796666477413626740,
                                          0.960289856497536232};
constexpr std::array<double, 4> kWeights = {0.362683783378361983, 0.313706645877887287, 0.222381034453374471,
                                            0.101228536290376259};
constexpr int kAngles = 64;

}  // namespace

std::string view_name(std::size_t i) {
  return fmt::format("calibration/view-{:02d}.png", i);
}

std::string plane_name(std::size_t i, std::size_t count) {
  return count == 1 ? "calibration/plane.png" : fmt::format("calibration/plane-{:02d}.png", i);
}

std::string experiment_toml(const Scenario& scenario) {
  std::string text;
  const auto line = [&](std::string_view key, const std::string& value) {
    text += fmt::format("{} = {}\n", key, value);
  };
  const auto table = [&](std::string_view name) { text += fmt::format("\n{}\n", name); };
  line("format", "1");
  line("name", base::toml_string(scenario.motion.name));
  line("gravity_m_s2", number(scenario.motion.gravity_m_s2));
  line("gravity_sd_m_s2", "0.0");  // whatever its digits: the motion was computed with it
  table("[camera]");
  line("frame_rate_hz", number(scenario.recording.frame_rate_hz));
  line("exposure_s", number(scenario.recording.exposure_s));
  const Shutter& shutter = scenario.recording.shutter;
  line("shutter", shutter.rolling ? "\"rolling\"" : "\"global\"");
  if (shutter.rolling) line("line_readout_s", number(shutter.line_readout_s));
  if (shutter.bottom_first) line("first_row", "\"bottom\"");
  line("bit_depth", fmt::format("{}", scenario.sensor.bit_depth));
  if (scenario.recording.clock.variable) line("time", "\"container\"");
  table("[calibration]");
  line("pattern", "\"chessboard\"");
  line("inner_corners", fmt::format("[{}, {}]", scenario.pattern.inner_columns, scenario.pattern.inner_rows));
  line("square_m", number(scenario.pattern.square_m));
  line("views", "\"calibration/view-*.png\"");
  line("plane", scenario.pattern.plane_x_m.size() == 1 ? "\"calibration/plane.png\"" : "\"calibration/plane-*.png\"");
  if (const auto region = plumb_region(scenario)) {
    table("[plumb]");
    line("view", "\"plumb.png\"");
    line("region", fmt::format("[{}, {}, {}, {}]", region->x, region->y, region->width, region->height));
  }
  table("[marker]");
  line("diameter_m", number(scenario.marker.diameter_m));
  line("height_m", number(scenario.marker.height_m));
  table("[track]");
  line("downhill", scenario.track.downhill > 0 ? "\"+X\"" : "\"-X\"");
  line("length_m", number(scenario.track.length_m));
  for (const sim::ConfigurationSetup& configuration : scenario.motion.configurations) {
    for (const sim::MotionSetup& motion : configuration.motions) {
      table("[[clip]]");
      line("name", base::toml_string(motion.name));
      line("file", base::toml_string("clips/" + file_name_of(scenario.codec, scenario.compression, motion.name)));
      line("mass_kg", number(configuration.body.mass_kg));
      line("incline_deg", number(configuration.stated_incline_rad * base::kDegreesPerRad));
      if (configuration.stated_incline_sd_rad > 0.0) {
        line("incline_sd_deg", number(configuration.stated_incline_sd_rad * base::kDegreesPerRad));
      }
      line("launched", base::toml_string(word_of(motion.launched)));
      line("group", base::toml_string(configuration.group));
    }
  }
  return text;
}

double x_origin_m(const Scenario& scenario, double incline_rad) {
  return plane_board(scenario, 0).X_WP.translation().dot(track_direction_W(scenario.track, incline_rad));
}

std::string truth_json(const Scenario& scenario, std::uint64_t seed) {
  nlohmann::ordered_json configurations = nlohmann::ordered_json::array();
  nlohmann::ordered_json clips = nlohmann::ordered_json::array();
  for (const sim::ConfigurationSetup& configuration : scenario.motion.configurations) {
    const std::optional<sim::LinearLaw> law = sim::linear_law(configuration.body);
    nlohmann::ordered_json names = nlohmann::ordered_json::array();
    for (const sim::MotionSetup& motion : configuration.motions) {
      names.push_back(motion.name);
      const FrameClock clock(scenario.recording.clock, scenario.recording.frame_rate_hz, seed,
                             static_cast<std::uint32_t>(clips.size()));
      clips.push_back({{"name", motion.name},
                       {"configuration", configuration.name},
                       {"frames", clock.frames_of(frame_count(scenario.recording, motion))},
                       {"x_origin_m", x_origin_m(scenario, configuration.body.incline_rad)},
                       {"trajectory", "trajectory-" + motion.name + ".csv"},
                       {"marker", "marker-" + motion.name + ".csv"},
                       {"frame_times", "frames-" + motion.name + ".csv"}});
    }
    configurations.push_back(
        {{"name", configuration.name},
         {"mass_kg", configuration.body.mass_kg},
         {"stated_incline_deg", configuration.stated_incline_rad * base::kDegreesPerRad},
         {"group", configuration.group},
         {"k_over_m_1_s", law ? nlohmann::ordered_json(law->k_over_m_1_s) : nlohmann::ordered_json(nullptr)},
         {"mu", law ? nlohmann::ordered_json(law->mu) : nlohmann::ordered_json(nullptr)},
         {"alpha_deg", configuration.body.incline_rad * base::kDegreesPerRad},
         {"v_lim_m_s", maybe(sim::limit_speed_m_s(configuration.body))},
         {"clips", names}});
  }
  const nlohmann::ordered_json truth = {{"format", 1},    {"name", scenario.motion.name},
                                        {"seed", seed},   {"configurations", configurations},
                                        {"clips", clips}, {"camera", sections_truth(scenario)}};
  return base::json_text(truth) + "\n";
}

std::optional<Ellipse> image_of_sphere(const Eigen::Vector3d& center_C, double radius_m) {
  const double distance2 = center_C.squaredNorm();
  if (!(center_C.z() > radius_m)) return std::nullopt;
  // d^T A d <= 0 inside, with d = (x, y, 1).
  const Eigen::Matrix3d conic =
      (distance2 - radius_m * radius_m) * Eigen::Matrix3d::Identity() - center_C * center_C.transpose();
  const Eigen::Matrix2d quadratic = conic.topLeftCorner<2, 2>();
  const Eigen::Vector2d linear = conic.topRightCorner<2, 1>();
  Ellipse ellipse;
  ellipse.center = -quadratic.inverse() * linear;
  // Value at the centre: det(A) / det(quadratic); written out it is -r² (|c|² - r²)² / det without cancellation.
  const double inside = distance2 - radius_m * radius_m;
  const double at_center = -radius_m * radius_m * inside * inside / quadratic.determinant();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(quadratic);
  ellipse.axis_u = axes.eigenvectors().col(0) * std::sqrt(-at_center / axes.eigenvalues()(0));
  ellipse.axis_v = axes.eigenvectors().col(1) * std::sqrt(-at_center / axes.eigenvalues()(1));
  return ellipse;
}

AreaMoments image_of(const Camera& camera, const Ellipse& ellipse) {
  AreaMoments moments;
  const double ellipse_jacobian =
      std::abs(ellipse.axis_u.x() * ellipse.axis_v.y() - ellipse.axis_u.y() * ellipse.axis_v.x());
  for (std::size_t i = 0; i < kNodes.size() * 2; ++i) {
    const std::size_t node = i / 2;
    const double radius = 0.5 * (1.0 + (i % 2 == 0 ? kNodes[node] : -kNodes[node]));
    for (int k = 0; k < kAngles; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / kAngles;
      const Eigen::Vector2d at =
          ellipse.center + radius * (std::cos(angle) * ellipse.axis_u + std::sin(angle) * ellipse.axis_v);
      const double weight = 0.5 * kWeights[node] * radius * (2.0 * std::numbers::pi / kAngles) * ellipse_jacobian *
                            distortion_jacobian(camera.lens, at).determinant() * camera.focal_px.prod();
      moments.area_px += weight;
      moments.centroid_px += weight * (distort(camera.lens, at).cwiseProduct(camera.focal_px) + camera.center_px);
    }
  }
  moments.centroid_px /= moments.area_px;
  return moments;
}

std::optional<MarkerInImage> marker_in_image(const Scenario& scenario, const sim::Body& body,
                                             const FrameMotion& frame) {
  const Camera& camera = scenario.camera;
  const Recording& recording = scenario.recording;
  const auto center_C = [&](double x_m, double t_s) -> Eigen::Vector3d {
    const Eigen::Vector3d at_rest = camera.X_WC.inverse() * marker_position_W(scenario, body.incline_rad, x_m);
    return scenario.mount.moves() ? mount_at(scenario.mount, t_s).inverse() * at_rest : at_rest;
  };
  MarkerInImage marker;
  marker.x_m = frame.middle.x_m;
  marker.t_s = frame.middle.t_s;
  const double middle_row = 0.5 * (camera.height_px - 1);
  double sim_s = mid_exposure_s(recording, frame, middle_row);
  if (recording.shutter.rolling) {
    // The row's time and the centre's row depend on one another: t = mid-exposure of the row v(t), a contraction if the
    // marker moves by less than a row per line time.
    double row = middle_row;
    for (int i = 0;; ++i) {
      sim_s = mid_exposure_s(recording, frame, row);
      marker.x_m = frame.path.x_m(sim_s);
      const auto pixel = pixel_of(camera, center_C(marker.x_m, sim_s).hnormalized());
      if (!pixel) return std::nullopt;
      const double change = pixel->y() - row;
      row = pixel->y();
      if (std::abs(change) < 1e-9) break;
      if (i == 200) {
        throw base::NumericalError(fmt::format("frame {}: the marker moves as fast as the rows are read", frame.frame));
      }
    }
    marker.t_s += recording.shutter.delay_s(row) - recording.shutter.delay_s(middle_row);
  }
  const Eigen::Vector3d c = center_C(marker.x_m, sim_s);
  const auto pixel = c.z() > 0.0 ? pixel_of(camera, c.hnormalized()) : std::nullopt;
  const auto outline = image_of_sphere(c, 0.5 * scenario.marker.diameter_m);
  if (!pixel || !outline || !in_image(camera, *pixel)) return std::nullopt;
  marker.center_px = *pixel;
  marker.centroid_px = image_of(camera, *outline).centroid_px;
  return marker;
}

void write_ideal_frames(const Scenario& scenario, const std::filesystem::path& truth_dir, int jobs) {
  const Scenario ideal = ideal_of(scenario);
  const ClipSet set(ideal, jobs);
  const double code_per_e = 0.75 * 255.0 / electrons_of_white(ideal);
  base::in_parallel(jobs, set.size(), [&](const auto& next) {
    for (std::size_t clip = next(); clip < set.size(); clip = next()) {
      const std::string name = set.motion(clip).name;
      ClipRenderer renderer = set.renderer(clip, 0);
      VideoFormat format;
      format.codec = Codec::magicyuv;
      format.width = ideal.camera.width_px;
      format.height = ideal.camera.height_px;
      format.frame_rate_hz = ideal.recording.frame_rate_hz;
      const auto writer = open_video(truth_dir / ("ideal-" + name + ".mkv"), format);
      base::CsvWriter marker_truth("frame,t_s,u_px,v_px");
      std::vector<std::uint8_t> codes(static_cast<std::size_t>(format.width) * format.height);
      const sim::Body& body = set.configuration(clip).body;
      // The motion in the time of the real camera's shutter; for each frame its middle.
      const auto visit = [&](const FrameMotion& real) {
        FrameMotion frame;
        frame.frame = real.frame;
        frame.start_s = real.start_s;
        frame.middle = real.middle;
        frame.x_m = {real.middle.x_m};
        const FloatImage& expected_e = renderer.expected(frame);
        for (std::size_t i = 0; i < codes.size(); ++i) {
          const double code = std::round(code_per_e * static_cast<double>(expected_e.values[i]));
          codes[i] = static_cast<std::uint8_t>(std::clamp(code, 0.0, 255.0));
        }
        writer->write(std::span<const std::uint8_t>(codes));
        if (const auto marker = marker_in_image(ideal, body, frame)) {
          marker_truth.number(static_cast<double>(frame.frame)).number(marker->t_s);
          marker_truth.number(marker->center_px.x()).number(marker->center_px.y());
          marker_truth.end_row();
        }
      };
      for_each_frame(body, set.motion(clip), scenario.recording, renderer.longest_step_m(), visit);
      writer->finish();
      base::write_file(truth_dir / fmt::format("ideal-{}.csv", name), marker_truth.str());
    }
  });
}

}  // namespace glidelab::render
