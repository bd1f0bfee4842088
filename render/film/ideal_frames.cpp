#include "render/film/ideal_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/files/staged_output.h"
#include "base/parallel.h"
#include "base/text/csv.h"
#include "render/film/clip_set.h"
#include "render/film/marker_truth.h"
#include "render/scenario/scenario_sections.h"
#include "render/video/video_writer.h"

namespace glidelab::render {

void write_ideal_frames(const Scenario& scenario, const std::filesystem::path& truth_dir, int jobs) {
  const Scenario ideal = ideal_of(scenario);
  const ClipSet set(ideal, jobs);
  const double code_per_e = 0.75 * 255.0 / electrons_of_white(ideal);
  base::in_parallel(jobs, set.size(), [&](const auto& next) {
    for (std::size_t clip = next(); clip < set.size(); clip = next()) {
      const std::string name = set.motion(clip).name;
      ClipRenderer renderer = set.renderer(clip, 0);
      VideoFormat format;
      format.codec = Codec::ffv1;
      format.width = ideal.camera.width_px;
      format.height = ideal.camera.height_px;
      format.frame_rate_hz = ideal.recording.frame_rate_hz;
      const auto writer = open_video(truth_dir / ("ideal-" + name + ".mkv"), format);
      base::CsvWriter marker_truth("frame,t_s,u_px,v_px");
      std::vector<std::uint8_t> codes(static_cast<std::size_t>(format.width) * format.height);
      const sim::Body& body = set.configuration(clip).body;
      // The motion as the real camera's shutter counts it; of each frame its middle.
      const auto visit = [&](const FrameMotion& real) {
        FrameMotion frame;
        frame.frame = real.frame;
        frame.start_s = real.start_s;
        frame.middle = real.middle;
        frame.x_m = {real.middle.x_m};
        const FloatPicture& expected_e = renderer.expected(frame);
        for (std::size_t i = 0; i < codes.size(); ++i) {
          const double code = std::round(code_per_e * static_cast<double>(expected_e.values[i]));
          codes[i] = static_cast<std::uint8_t>(std::clamp(code, 0.0, 255.0));
        }
        writer->write(std::span<const std::uint8_t>(codes));
        if (const auto marker = marker_in_picture(ideal, body, frame)) {
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
