#include "render/film/render_experiment.h"

#include <fmt/format.h>
#include <opencv2/core.hpp>

#include <atomic>
#include <memory>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "base/long_work.h"
#include "base/text/csv.h"
#include "render/film/clip_renderer.h"
#include "render/film/stills.h"
#include "render/film/truth_files.h"
#include "render/video/video_writer.h"

namespace glidelab::render {
namespace {

namespace fs = std::filesystem;

// Duration of a still relative to a frame, for the progress.
constexpr double kStillWork = 30.0;

void make_folder(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) base::throw_system_error(path.string(), "cannot be made", error.value());
}

/// A table that grows on disk, for clips of any length.
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

/// The truth of one clip, frame by frame of the file.
class ClipTruth {
 public:
  ClipTruth(const fs::path& folder, const std::string& clip)
      : trajectory_(folder / fmt::format("trajectory-{}.csv", clip), "t_s,x_m,v_m_s,a_m_s2,mode"),
        marker_(folder / fmt::format("marker-{}.csv", clip), "frame,t_s,u_px,v_px,centroid_u_px,centroid_v_px"),
        times_(folder / fmt::format("frames-{}.csv", clip), "frame,slot,t_s,stamp_s,duplicate") {}

  /// Adds a frame of the file that shows its own slot's exposure, or a repeated earlier one.
  void add(const ClipStream::Next& frame, const std::optional<MarkerInImage>& in_image) {
    const sim::State& state = frame.shown->middle;
    trajectory_.row().number(state.t_s).number(state.x_m).number(state.v_m_s).number(state.a_m_s2);
    trajectory_.row().text(sim::name_of(state.mode));
    trajectory_.end_row();
    const auto number = static_cast<double>(frames_++);
    if (in_image) {
      marker_.row().number(number).number(in_image->t_s);
      marker_.row().number(in_image->center_px.x()).number(in_image->center_px.y());
      marker_.row().number(in_image->centroid_px.x()).number(in_image->centroid_px.y());
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
  std::optional<MarkerInImage> marker;
  while (const std::optional<ClipStream::Next> next = stream.next()) {
    if (!next->repeated) {
      stream.read(*next->shown, all, std::span<Code>(codes));
      marker = marker_in_image(scenario, body, *next->shown);
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

}  // namespace

RenderSummary render_experiment(const Scenario& scenario, const fs::path& experiment_dir, const fs::path& truth_dir,
                                const RenderOptions& options, const base::Progress& progress,
                                std::shared_ptr<const Stage> stage) {
  make_folder(experiment_dir / "clips");
  make_folder(experiment_dir / "calibration");
  make_folder(truth_dir);

  const ClipCount count = count_clips(scenario, options.seed);
  const bool draws_stage = !stage && (options.stills || options.clips);
  const std::size_t images =
      (options.stills ? count_stills(scenario) : 0) + (draws_stage ? count_set_ups(scenario) : 0);
  const double all_work =
      kStillWork * static_cast<double>(images) + (options.clips ? static_cast<double>(count.frames) : 0.0);
  std::atomic<double> done{0.0};
  const auto advance = [&](double work) {
    double before = done.load();
    while (!done.compare_exchange_weak(before, before + work)) {
    }
    progress("rendering", std::min(1.0, (before + work) / all_work));
  };
  const auto image_done = [&] { advance(kStillWork); };

  if (draws_stage) stage = set_stage(scenario, options.jobs, image_done);
  if (options.stills) {
    take_stills(scenario, *stage, options.seed, options.jobs, [&](const std::string& name, const cv::Mat& codes) {
      write_png(experiment_dir / name, codes);
      image_done();
    });
  }
  if (options.clips) {
    const auto set = std::make_shared<const ClipSet>(scenario, stage);
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
