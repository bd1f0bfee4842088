#include "render/render_experiment.h"

#include <fmt/format.h>

#include <map>
#include <opencv2/core.hpp>

#include "base/csv.h"
#include "base/errors.h"
#include "base/staged_output.h"
#include "render/clip_renderer.h"
#include "render/folders.h"
#include "render/ideal_frames.h"
#include "render/marker_truth.h"
#include "render/parallel.h"
#include "render/readout.h"
#include "render/static_painter.h"
#include "render/video_writer.h"

namespace glidelab::render {
namespace {

namespace fs = std::filesystem;

/// A still picture that has to be taken.
struct Still {
  std::string name;  ///< within the experiment folder
  StaticScene scene;
};

/// What stands still while the clips of one set-up of the track are recorded.
struct SetUp {
  StaticScene scene;
  FloatPicture background_e;
  std::optional<FinePicture> fine;  ///< for a camera that moves
};

struct Clip {
  const sim::ConfigurationSetup* configuration = nullptr;
  const sim::MotionSetup* motion = nullptr;
  const SetUp* set_up = nullptr;
  std::uint32_t stream = 0;
};

// Noise streams: clips count from 0, stills from here.
constexpr std::uint32_t kFirstStill = 0x40000000u;
// How long a still takes beside a frame, for the progress.
constexpr double kStillWork = 30.0;

std::vector<Still> stills_of(const Scenario& scenario, std::uint64_t seed) {
  const StaticScene track = empty_track(scenario, scenario.motion.configurations.front().body.incline_rad);
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

FrameClock clock_of(const Scenario& scenario, const Clip& clip, std::uint64_t seed) {
  return {scenario.recording.clock, scenario.recording.frame_rate_hz, seed, clip.stream};
}

/// What the truth says of one clip, frame by frame of the file.
struct ClipTruth {
  base::CsvWriter trajectory{"t_s,x_m,v_m_s,a_m_s2,mode"};
  base::CsvWriter marker{"frame,t_s,u_px,v_px,centroid_u_px,centroid_v_px"};
  base::CsvWriter times{"frame,slot,t_s,stamp_s,duplicate"};
  std::size_t frames = 0;

  /// A frame of the file that shows `shown`, which was exposed in its own slot, and stands in `slot`.
  void add(const FrameMotion& shown, const std::optional<MarkerInPicture>& in_picture, std::size_t slot,
           double stamp_s) {
    const sim::State& state = shown.middle;
    trajectory.number(state.t_s).number(state.x_m).number(state.v_m_s).number(state.a_m_s2);
    trajectory.text(sim::name_of(state.mode));
    trajectory.end_row();
    if (in_picture) {
      marker.number(static_cast<double>(frames)).number(in_picture->t_s);
      marker.number(in_picture->center_px.x()).number(in_picture->center_px.y());
      marker.number(in_picture->centroid_px.x()).number(in_picture->centroid_px.y());
      marker.end_row();
    }
    times.number(static_cast<double>(frames)).number(static_cast<double>(slot)).number(state.t_s).number(stamp_s);
    times.number(shown.frame == slot ? 0.0 : 1.0);
    times.end_row();
    ++frames;
  }
};

double longest_clip_s(const Scenario& scenario) {
  double longest = 0.0;
  for (const sim::ConfigurationSetup& configuration : scenario.motion.configurations) {
    for (const sim::MotionSetup& motion : configuration.motions) longest = std::max(longest, motion.duration_s);
  }
  return longest;
}

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
void render_frames(const Scenario& scenario, const Clip& clip, const FrameClock& clock, ClipRenderer& renderer,
                   VideoWriter& writer, ClipTruth& truth, const std::function<void()>& frame_done) {
  const PixelRect all{0, 0, scenario.camera.width_px, scenario.camera.height_px};
  std::vector<Code> codes(static_cast<std::size_t>(all.width) * all.height);
  FrameMotion shown;
  std::optional<MarkerInPicture> marker;
  const auto visit = [&](const FrameMotion& frame) {
    const FrameFate fate = clock.fate(frame.frame);
    if (fate == FrameFate::recorded) {
      renderer.read(frame, all, std::span<Code>(codes));
      shown = frame;
      marker = marker_in_picture(scenario, clip.configuration->body, frame);
    }
    if (fate != FrameFate::dropped) {
      const double stamp_s = clock.stamp_s(frame.frame);
      write_frame(writer, std::span<const Code>(codes),
                  scenario.recording.clock.variable ? std::optional(stamp_s) : std::nullopt);
      truth.add(shown, marker, frame.frame, stamp_s);
    }
    frame_done();
  };
  for_each_frame(clip.configuration->body, *clip.motion, scenario.recording, clock, renderer.longest_step_m(), visit,
                 renderer.detail());
}

}  // namespace

RenderSummary render_experiment(const Scenario& scenario, const fs::path& experiment_dir, const fs::path& truth_dir,
                                const RenderOptions& options, const base::Progress& progress) {
  make_folder(experiment_dir / "clips");
  make_folder(experiment_dir / "calibration");
  make_folder(truth_dir);

  const RayTable rays = make_ray_table(scenario.camera, scenario.vignetting);
  // The clips are taken after the calibration, perhaps with another focus.
  const Scenario in_clips = as_in_clips(scenario);
  const bool refocused = scenario.mount.focal_change != 0.0;
  const RayTable refocused_rays = refocused ? make_ray_table(in_clips.camera, scenario.vignetting) : RayTable{};
  const RayTable& clip_rays = refocused ? refocused_rays : rays;
  const double white_e = electrons_of_white(scenario);
  const std::vector<Still> stills = stills_of(scenario, options.seed);
  std::map<std::string, SetUp> set_ups;
  std::vector<Clip> clips;
  RenderSummary summary;
  double all_slots = 0.0;
  for (const sim::ConfigurationSetup& configuration : scenario.motion.configurations) {
    SetUp& set_up = set_ups[configuration.group];
    if (set_up.scene.boxes.empty()) set_up.scene = empty_track(scenario, configuration.body.incline_rad);
    for (const sim::MotionSetup& motion : configuration.motions) {
      clips.push_back({&configuration, &motion, &set_up, static_cast<std::uint32_t>(clips.size())});
      const std::size_t slots = frame_count(scenario.recording, motion);
      all_slots += static_cast<double>(slots);
      summary.frames += clock_of(scenario, clips.back(), options.seed).frames_of(slots);
    }
  }
  summary.clips = clips.size();
  std::vector<SetUp*> backgrounds;
  for (auto& [name, set_up] : set_ups) backgrounds.push_back(&set_up);

  const double all_work = kStillWork * static_cast<double>(stills.size() + backgrounds.size()) + all_slots;
  std::atomic<double> done{0.0};
  const auto advance = [&](double work) {
    double before = done.load();
    while (!done.compare_exchange_weak(before, before + work)) {
    }
    progress("rendering", std::min(1.0, (before + work) / all_work));
  };

  const Readout still_readout(with_8_bits(scenario.sensor), scenario.recording.exposure_s, options.seed,
                              scenario.camera.width_px, scenario.camera.height_px);
  in_parallel(options.jobs, stills.size() + backgrounds.size(), [&](const auto& next) {
    StaticPainter painter(scenario.camera, rays, scenario.focus);
    const PixelRect all{0, 0, scenario.camera.width_px, scenario.camera.height_px};
    std::vector<std::uint8_t> codes(static_cast<std::size_t>(all.width) * all.height);
    for (std::size_t i = next(); i < stills.size() + backgrounds.size(); i = next()) {
      if (i < backgrounds.size()) {
        SetUp& set_up = *backgrounds[i];
        set_up.background_e =
            scaled(refocused ? StaticPainter(in_clips.camera, clip_rays, scenario.focus).paint(set_up.scene)
                             : painter.paint(set_up.scene),
                   white_e);
        if (scenario.mount.moves()) {
          set_up.fine =
              fine_picture(in_clips.camera, scenario.mount, scenario.focus, set_up.scene, longest_clip_s(scenario));
        }
      } else {
        const std::size_t number = i - backgrounds.size();
        const FloatPicture expected_e = scaled(painter.paint(stills[number].scene), white_e);
        still_readout.read(expected_e, kFirstStill + static_cast<std::uint32_t>(number), 0, all,
                           std::span<std::uint8_t>(codes));
        write_png(experiment_dir / stills[number].name, cv::Mat(all.height, all.width, CV_8U, codes.data()));
      }
      advance(kStillWork);
    }
  });

  in_parallel(options.jobs, clips.size(), [&](const auto& next) {
    for (std::size_t i = next(); i < clips.size(); i = next()) {
      const Clip& clip = clips[i];
      const fs::path file =
          experiment_dir / "clips" / file_name_of(scenario.codec, scenario.compression, clip.motion->name);
      if (!options.clips) {
        base::write_file(file, "");
        continue;
      }
      ClipRenderer renderer(in_clips, *clip.configuration, clip.set_up->scene, clip_rays, clip.set_up->background_e,
                            options.seed, clip.stream, clip.set_up->fine ? &*clip.set_up->fine : nullptr);
      const VideoFormat format{scenario.codec,
                               scenario.camera.width_px,
                               scenario.camera.height_px,
                               scenario.recording.frame_rate_hz,
                               1,
                               scenario.compression,
                               scenario.recording.clock.variable};
      const auto writer = open_video(file, format);
      const FrameClock clock = clock_of(scenario, clip, options.seed);
      ClipTruth truth;
      const auto frame_done = [&] { advance(1.0); };
      if (scenario.sensor.bit_depth > 8) {
        render_frames<std::uint16_t>(in_clips, clip, clock, renderer, *writer, truth, frame_done);
      } else {
        render_frames<std::uint8_t>(in_clips, clip, clock, renderer, *writer, truth, frame_done);
      }
      writer->finish();
      const std::string& name = clip.motion->name;
      base::write_file(truth_dir / fmt::format("trajectory-{}.csv", name), truth.trajectory.str());
      base::write_file(truth_dir / fmt::format("marker-{}.csv", name), truth.marker.str());
      base::write_file(truth_dir / fmt::format("frames-{}.csv", name), truth.times.str());
    }
  });

  if (options.ideal) write_ideal_frames(scenario, truth_dir, options.jobs);
  base::write_file(experiment_dir / "experiment.toml", experiment_toml(scenario));
  base::write_file(truth_dir / "truth.json", truth_json(scenario, options.seed));
  return summary;
}

}  // namespace glidelab::render
