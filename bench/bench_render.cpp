/// Frames a second of the paper's scenario, where the time of a frame goes, and what a still picture takes.
/// Each benchmark states frames (or pixels) a second and thread; with two threads Google Benchmark gives the rate of
/// both.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <memory>
#include <vector>

#include "render/clip_renderer.h"
#include "render/static_painter.h"
#include "render/video_writer.h"

namespace {

using namespace glidelab;
using namespace glidelab::render;

/// What all frames of one clip share, made once.
struct Stage {
  Scenario scenario = read_scenario(GLIDELAB_SOURCE_DIR "/scenarios/paper/inclined.toml");
  const sim::ConfigurationSetup& configuration = scenario.motion.configurations.back();
  RayTable rays = make_ray_table(scenario.camera);
  StaticScene scene = empty_track(scenario, configuration.body.incline_rad);
  FloatPicture background_e;
  std::vector<FrameMotion> frames;
  PixelRect all{0, 0, scenario.camera.width_px, scenario.camera.height_px};

  Stage() {
    StaticPainter painter(scenario.camera, rays);
    background_e = painter.paint(scene);
    for (float& value : background_e.values) value *= static_cast<float>(electrons_of_white(scenario));
    const ClipRenderer renderer = clip_renderer();
    for_each_frame(configuration.body, configuration.motions.front(), scenario.recording, renderer.longest_step_m(),
                   [&](const FrameMotion& frame) { frames.push_back(frame); });
  }
  ClipRenderer clip_renderer() const { return ClipRenderer(scenario, configuration, scene, rays, background_e, 1, 0); }
};

const Stage& stage() {
  static const Stage made;
  return made;
}

void frames_in_memory(benchmark::State& state) {
  const Stage& made = stage();
  ClipRenderer renderer = made.clip_renderer();
  std::vector<std::uint8_t> codes(made.background_e.values.size());
  std::size_t k = 0;
  for (auto _ : state) {
    renderer.read(made.frames[k++ % made.frames.size()], made.all, std::span<std::uint8_t>(codes));
    benchmark::DoNotOptimize(codes.data());
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()));
}
BENCHMARK(frames_in_memory)->Unit(benchmark::kMillisecond)->UseRealTime()->Threads(1)->Threads(2);

void frames_to_file(benchmark::State& state) {
  const Stage& made = stage();
  ClipRenderer renderer = made.clip_renderer();
  const auto codec = static_cast<Codec>(state.range(0));
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() /
      ("glidelab-bench-" + std::to_string(state.thread_index()) + (codec == Codec::ffv1 ? ".mkv" : ".avi"));
  const auto writer = open_video(path, {codec, made.all.width, made.all.height, 200.0, 1});
  std::vector<std::uint8_t> codes(made.background_e.values.size());
  std::size_t k = 0;
  for (auto _ : state) {
    renderer.read(made.frames[k++ % made.frames.size()], made.all, std::span<std::uint8_t>(codes));
    writer->write(std::span<const std::uint8_t>(codes));
  }
  writer->finish();
  std::filesystem::remove(path);
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()));
  state.SetLabel(codec == Codec::ffv1 ? "ffv1" : "raw");
}
BENCHMARK(frames_to_file)
    ->Arg(static_cast<int>(Codec::ffv1))
    ->Arg(static_cast<int>(Codec::raw))
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->Threads(1)
    ->Threads(2);

void expected_electrons_of_a_frame(benchmark::State& state) {
  const Stage& made = stage();
  ClipRenderer renderer = made.clip_renderer();
  std::size_t k = 0;
  for (auto _ : state) benchmark::DoNotOptimize(renderer.expected(made.frames[k++ % made.frames.size()]));
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()));
}
BENCHMARK(expected_electrons_of_a_frame)->Unit(benchmark::kMicrosecond);

void sensor_pixels(benchmark::State& state) {
  const Stage& made = stage();
  const auto simd = static_cast<Simd>(state.range(0));
  std::vector<std::uint8_t> codes(made.background_e.values.size());
  std::uint32_t frame = 0;
  for (auto _ : state) {
    read_out(made.scenario.sensor, made.background_e, {1, 0, frame++}, made.all, std::span<std::uint8_t>(codes), simd);
    benchmark::DoNotOptimize(codes.data());
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * codes.size()));
  state.SetLabel(simd == Simd::best ? "best instructions" : "baseline instructions");
}
BENCHMARK(sensor_pixels)
    ->Arg(static_cast<int>(Simd::best))
    ->Arg(static_cast<int>(Simd::baseline))
    ->Unit(benchmark::kMillisecond);

/// The same with what a real sensor adds: fixed patterns, then a tone curve, then a mosaic.
void readout_pixels(benchmark::State& state) {
  const Stage& made = stage();
  Sensor sensor = made.scenario.sensor;
  const char* labels[] = {"plain", "patterns", "patterns, tone", "patterns, tone, mosaic"};
  if (state.range(0) > 0) sensor.pixels = {20.0, 0.01, 3.0, 1e-4, 1e4, 1e-4};
  if (state.range(0) > 1) sensor.tone.kind = ToneCurve::Kind::bt709;
  if (state.range(0) > 2) sensor.colour = Colour::bayer;
  const Readout readout(sensor, made.scenario.recording.exposure_s, 1, made.all.width, made.all.height);
  std::vector<std::uint8_t> codes(made.background_e.values.size());
  std::uint32_t frame = 0;
  for (auto _ : state) {
    readout.read(made.background_e, 0, frame++, made.all, std::span<std::uint8_t>(codes));
    benchmark::DoNotOptimize(codes.data());
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * codes.size()));
  state.SetLabel(labels[state.range(0)]);
}
BENCHMARK(readout_pixels)->DenseRange(0, 3)->Unit(benchmark::kMillisecond);

void still_picture(benchmark::State& state) {
  const Stage& made = stage();
  StaticPainter painter(made.scenario.camera, made.rays);
  StaticScene scene = made.scene;
  scene.board = plane_board(made.scenario, 0);
  for (auto _ : state) benchmark::DoNotOptimize(painter.paint(scene));
}
BENCHMARK(still_picture)->Unit(benchmark::kMillisecond)->UseRealTime();

void ray_table_of_the_lens(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(make_ray_table(stage().scenario.camera));
}
BENCHMARK(ray_table_of_the_lens)->Unit(benchmark::kMillisecond);

}  // namespace
