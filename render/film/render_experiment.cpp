#include "render/film/render_experiment.h"

#include <fmt/format.h>
#include <opencv2/core.hpp>

#include <atomic>
#include <cmath>
#include <memory>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "base/long_work.h"
#include "base/math/angles.h"
#include "base/text/csv.h"
#include "render/film/clip_renderer.h"
#include "render/film/truth_files.h"
#include "render/paint/static_painter.h"
#include "render/random/streams.h"
#include "render/sensor/readout.h"
#include "render/video/video_writer.h"

namespace glidelab::render {
namespace {

/// A pose as a person would take it: where in the image (parts of its half width and height off the middle), how
/// large (part of the image's width), how tilted (degrees about the image's horizontal and vertical), how turned.
struct Pose {
  double right, down, width, tilt_x_deg, tilt_y_deg, turn_deg;
};

// Every part of the image is covered, every tilt comes with another place; cyclic beyond twelve.
constexpr Pose kPoses[] = {
    {0.00, 0.00, 0.78, 0.0, 0.0, 0.0},        {-0.55, -0.50, 0.52, 25.0, -25.0, 3.0},
    {0.55, -0.50, 0.52, 25.0, 25.0, -4.0},    {-0.55, 0.50, 0.52, -25.0, -25.0, -3.0},
    {0.55, 0.50, 0.52, -25.0, 25.0, 5.0},     {0.00, -0.45, 0.60, 33.0, 0.0, 2.0},
    {0.00, 0.45, 0.60, -33.0, 0.0, -6.0},     {-0.50, 0.00, 0.55, 0.0, -33.0, 8.0},
    {0.50, 0.00, 0.55, 0.0, 33.0, -7.0},      {0.05, 0.05, 0.66, 18.0, -28.0, 25.0},
    {-0.05, -0.05, 0.66, -28.0, 18.0, -25.0}, {0.30, -0.25, 0.50, 12.0, 20.0, 88.0},
};

double jitter(std::uint64_t seed, std::uint32_t view, std::uint32_t number) {
  return 2.0 * uniform_of(random_words(RandomPurpose::pattern_poses, {view, number, 0}, philox_key(seed))[0]) -
         1.0;  // -1 to 1
}

bool wholly_seen(const Camera& camera, const Chessboard& board, double margin_px) {
  const std::vector<Eigen::Vector3d> outline = outline_of(board);
  constexpr int kSteps = 16;  // the lens bends the edges
  for (std::size_t i = 0; i < outline.size(); ++i) {
    for (int k = 0; k < kSteps; ++k) {
      const Eigen::Vector3d p = outline[i] + (outline[(i + 1) % outline.size()] - outline[i]) * k / kSteps;
      const auto pixel = project(camera, p);
      if (!pixel || !in_picture(camera, *pixel, margin_px)) return false;
    }
  }
  return true;
}

}  // namespace

std::vector<Chessboard> calibration_boards(const Scenario& scenario, std::uint64_t seed) {
  const Camera& camera = scenario.camera;
  const PatternSetup& pattern = scenario.pattern;
  std::vector<Chessboard> boards;
  for (int view = 0; view < pattern.views; ++view) {
    Pose pose = kPoses[static_cast<std::size_t>(view) % std::size(kPoses)];
    const auto random = [&](std::uint32_t number) { return jitter(seed, static_cast<std::uint32_t>(view), number); };
    const double tilt_x = (pose.tilt_x_deg + 2.0 * random(0)) * base::kRadPerDegree;
    const double tilt_y = (pose.tilt_y_deg + 2.0 * random(1)) * base::kRadPerDegree;
    const double turn = (pose.turn_deg + 3.0 * random(2)) * base::kRadPerDegree;
    const Eigen::Matrix3d R_CP =
        (Eigen::AngleAxisd(tilt_x, Eigen::Vector3d::UnitX()) * Eigen::AngleAxisd(tilt_y, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()))
            .toRotationMatrix();
    Chessboard board;
    board.inner_columns = pattern.inner_columns;
    board.inner_rows = pattern.inner_rows;
    board.square_m = pattern.square_m;
    const double plate_m = (pattern.inner_columns + 1 + 2 * board.border_squares) * pattern.square_m;
    const Eigen::Vector3d middle_P(0.5 * (pattern.inner_columns - 1) * pattern.square_m,
                                   0.5 * (pattern.inner_rows - 1) * pattern.square_m, 0.0);
    bool found = false;
    // Moved towards the middle and away from the camera until it is wholly in the image.
    for (int attempt = 0; attempt < 60 && !found; ++attempt) {
      const double inward = std::pow(0.93, attempt);
      const double width = pose.width * std::pow(0.985, attempt);
      const Eigen::Vector2d pixel(0.5 * (camera.width_px - 1) * (1.0 + inward * (pose.right + 0.04 * random(3))),
                                  0.5 * (camera.height_px - 1) * (1.0 + inward * (pose.down + 0.04 * random(4))));
      const auto ray = undistorted_at(camera, pixel);
      if (!ray) continue;
      const double depth = camera.focal_px.x() * plate_m / (width * camera.width_px) * (1.0 + 0.03 * random(5));
      Eigen::Isometry3d X_CP = Eigen::Isometry3d::Identity();
      X_CP.linear() = R_CP;
      X_CP.translation() = depth * ray->homogeneous() - R_CP * middle_P;
      board.X_WP = camera.X_WC * X_CP;
      found = wholly_seen(camera, board, 3.0);
    }
    if (!found) throw base::NumericalError("calibration: no pose of the pattern is wholly in the image");
    boards.push_back(board);
  }
  return boards;
}

namespace {

namespace fs = std::filesystem;

/// A still image that has to be taken.
struct Still {
  std::string name;  ///< within the experiment folder
  StaticScene scene;
};

// How long a still takes beside a frame, for the progress.
constexpr double kStillWork = 30.0;

/// What stands behind the pattern and the plumb line.
StaticScene stills_background(const Scenario& scenario) {
  return empty_track(scenario, scenario.motion.configurations.front().body.incline_rad);
}

std::vector<Still> stills_of(const Scenario& scenario, std::uint64_t seed) {
  const StaticScene track = stills_background(scenario);
  std::vector<Still> stills;
  for (const Chessboard& board : calibration_boards(scenario, seed)) {
    stills.push_back({view_name(stills.size()), track});
    stills.back().scene.board = board;
  }
  const std::size_t planes = scenario.pattern.plane_x_m.size();
  for (std::size_t i = 0; i < planes; ++i) {
    stills.push_back({plane_name(i, planes), track});
    stills.back().scene.board = plane_board(scenario, i);
  }
  if (scenario.plumb) {
    stills.push_back({"plumb.png", track});
    stills.back().scene.plumb = plumb_line(*scenario.plumb, scenario.camera);
  }
  return stills;
}

void make_folder(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) base::throw_system_error(path.string(), "cannot be made", error.value());
}

FloatPicture scaled(FloatPicture picture, double factor) {
  for (float& value : picture.values) value = static_cast<float>(static_cast<double>(value) * factor);
  return picture;
}

/// Stills are kept with 8 bits, as a viewer program saves them.
Sensor with_8_bits(const Sensor& sensor) {
  Sensor shallow = sensor;
  shallow.bit_depth = 8;
  if (sensor.converter_bits || sensor.tone.kind != ToneCurve::Kind::linear || sensor.colour == Colour::bayer) {
    shallow.converter_bits = sensor.converter_bits.value_or(sensor.bit_depth);
    return shallow;
  }
  const double share = 255.0 / sensor.largest_code();
  shallow.gain_dn_per_e *= share;
  shallow.offset_dn *= share;
  return shallow;
}

/// A table that grows on disk, however long the clip.
class TruthTable {
 public:
  TruthTable(fs::path file, std::string_view header) : file_(std::move(file)), header_(header), rows_(header) {}
  base::CsvWriter& row() { return rows_; }
  void end_row() {
    rows_.end_row();
    constexpr std::size_t kMost = 1 << 16;
    if (rows_.str().size() > kMost) flush();
  }
  void flush() {
    const std::string_view header = std::string_view(header_);
    std::string_view text = rows_.str();
    if (written_) text.remove_prefix(header.size() + 1);
    base::append_file(file_, text);
    written_ = true;
    rows_ = base::CsvWriter(header);
  }

 private:
  fs::path file_;
  std::string header_;
  base::CsvWriter rows_;
  bool written_ = false;
};

/// What the truth says of one clip, frame by frame of the file.
class ClipTruth {
 public:
  ClipTruth(const fs::path& folder, const std::string& clip)
      : trajectory_(folder / fmt::format("trajectory-{}.csv", clip), "t_s,x_m,v_m_s,a_m_s2,mode"),
        marker_(folder / fmt::format("marker-{}.csv", clip), "frame,t_s,u_px,v_px,centroid_u_px,centroid_v_px"),
        times_(folder / fmt::format("frames-{}.csv", clip), "frame,slot,t_s,stamp_s,duplicate") {}

  /// A frame of the file that shows what was exposed in its own slot, or once more what was before.
  void add(const ClipStream::Next& frame, const std::optional<MarkerInPicture>& in_picture) {
    const sim::State& state = frame.shown->middle;
    trajectory_.row().number(state.t_s).number(state.x_m).number(state.v_m_s).number(state.a_m_s2);
    trajectory_.row().text(sim::name_of(state.mode));
    trajectory_.end_row();
    const auto number = static_cast<double>(frames_++);
    if (in_picture) {
      marker_.row().number(number).number(in_picture->t_s);
      marker_.row().number(in_picture->center_px.x()).number(in_picture->center_px.y());
      marker_.row().number(in_picture->centroid_px.x()).number(in_picture->centroid_px.y());
      marker_.end_row();
    }
    times_.row().number(number).number(static_cast<double>(frame.slot)).number(state.t_s).number(frame.stamp_s);
    times_.row().number(frame.repeated ? 1.0 : 0.0);
    times_.end_row();
  }

  void finish() {
    for (TruthTable* const table : {&trajectory_, &marker_, &times_}) table->flush();
  }

 private:
  TruthTable trajectory_, marker_, times_;
  std::size_t frames_ = 0;
};

template <typename Code>
void write_frame(VideoWriter& writer, std::span<const Code> codes, const std::optional<double>& stamp_s) {
  if constexpr (sizeof(Code) == 1) {
    if (stamp_s) {
      writer.write(codes, *stamp_s);
      return;
    }
  }
  writer.write(codes);
}

template <typename Code>
void write_frames(const Scenario& scenario, const sim::Body& body, ClipStream& stream, VideoWriter& writer,
                  ClipTruth& truth, const std::function<void()>& frame_done) {
  const PixelRect all{0, 0, scenario.camera.width_px, scenario.camera.height_px};
  std::vector<Code> codes(static_cast<std::size_t>(all.width) * all.height);
  std::optional<MarkerInPicture> marker;
  while (const std::optional<ClipStream::Next> next = stream.next()) {
    if (!next->repeated) {
      stream.read(*next->shown, all, std::span<Code>(codes));
      marker = marker_in_picture(scenario, body, *next->shown);
    }
    write_frame(writer, std::span<const Code>(codes),
                scenario.recording.clock.variable ? std::optional(next->stamp_s) : std::nullopt);
    truth.add(*next, marker);
    frame_done();
  }
}

fs::path clip_file(const Scenario& scenario, const fs::path& experiment_dir, const std::string& name) {
  return experiment_dir / "clips" / file_name_of(scenario.codec, scenario.compression, name);
}

/// One clip's file and its truth.
void render_clip(const std::shared_ptr<const ClipSet>& set, std::size_t clip, std::uint64_t seed,
                 const fs::path& experiment_dir, const fs::path& truth_dir, const std::function<void()>& frame_done) {
  const Scenario& scenario = set->scenario();
  const std::string& name = set->motion(clip).name;
  const VideoFormat format{scenario.codec,
                           scenario.camera.width_px,
                           scenario.camera.height_px,
                           scenario.recording.frame_rate_hz,
                           1,
                           scenario.compression,
                           scenario.recording.clock.variable};
  const auto writer = open_video(clip_file(scenario, experiment_dir, name), format);
  ClipStream stream(set, clip, seed);
  const sim::Body& body = set->configuration(clip).body;
  ClipTruth truth(truth_dir, name);
  if (scenario.sensor.bit_depth > 8) {
    write_frames<std::uint16_t>(scenario, body, stream, *writer, truth, frame_done);
  } else {
    write_frames<std::uint8_t>(scenario, body, stream, *writer, truth, frame_done);
  }
  writer->finish();
  truth.finish();
}

/// Views of the pattern and the plumb line, as the camera was before the clips.
void render_stills(const Scenario& scenario, const RenderOptions& options, const fs::path& experiment_dir,
                   const std::function<void()>& still_done) {
  const RayTable rays = make_ray_table(scenario.camera, scenario.vignetting);
  const double white_e = electrons_of_white(scenario);
  const std::vector<Still> stills = stills_of(scenario, options.seed);
  const FloatPicture empty = StaticPainter(scenario.camera, rays, scenario.focus).paint(stills_background(scenario));
  still_done();
  const Readout readout(with_8_bits(scenario.sensor), scenario.recording.exposure_s, options.seed,
                        scenario.camera.width_px, scenario.camera.height_px);
  base::in_parallel(options.jobs, stills.size(), [&](const auto& next) {
    StaticPainter painter(scenario.camera, rays, scenario.focus);
    const PixelRect all{0, 0, scenario.camera.width_px, scenario.camera.height_px};
    std::vector<std::uint8_t> codes(static_cast<std::size_t>(all.width) * all.height);
    for (std::size_t i = next(); i < stills.size(); i = next()) {
      const FloatPicture expected_e = scaled(painter.paint_before(empty, stills[i].scene), white_e);
      readout.read(expected_e, kFirstStillStream + static_cast<std::uint32_t>(i), 0, all,
                   std::span<std::uint8_t>(codes));
      write_png(experiment_dir / stills[i].name, cv::Mat(all.height, all.width, CV_8U, codes.data()));
      still_done();
    }
  });
}

}  // namespace

RenderSummary render_experiment(const Scenario& scenario, const fs::path& experiment_dir, const fs::path& truth_dir,
                                const RenderOptions& options, const base::Progress& progress) {
  make_folder(experiment_dir / "clips");
  make_folder(experiment_dir / "calibration");
  make_folder(truth_dir);

  const ClipCount count = count_clips(scenario, options.seed);
  const std::size_t pictures = (options.stills ? 1 + stills_of(scenario, options.seed).size() : 0) +
                               (options.clips ? count_set_ups(scenario) : 0);
  const double all_work =
      kStillWork * static_cast<double>(pictures) + (options.clips ? static_cast<double>(count.frames) : 0.0);
  std::atomic<double> done{0.0};
  const auto advance = [&](double work) {
    double before = done.load();
    while (!done.compare_exchange_weak(before, before + work)) {
    }
    progress("rendering", std::min(1.0, (before + work) / all_work));
  };
  const auto picture_done = [&] { advance(kStillWork); };

  if (options.stills) render_stills(scenario, options, experiment_dir, picture_done);
  if (options.clips) {
    const auto set = std::make_shared<const ClipSet>(scenario, options.jobs, picture_done);
    base::for_each_parallel(set->size(), options.jobs, [&](std::size_t clip) {
      render_clip(set, clip, options.seed, experiment_dir, truth_dir, [&] { advance(1.0); });
    });
  } else {
    for (const sim::ConfigurationSetup& configuration : scenario.motion.configurations) {
      for (const sim::MotionSetup& motion : configuration.motions) {
        base::write_file(clip_file(scenario, experiment_dir, motion.name), "");
      }
    }
  }

  if (options.ideal) write_ideal_frames(scenario, truth_dir, options.jobs);
  base::write_file(experiment_dir / "experiment.toml", experiment_toml(scenario));
  base::write_file(truth_dir / "truth.json", truth_json(scenario, options.seed));
  return {count.clips, count.frames};
}

}  // namespace glidelab::render
