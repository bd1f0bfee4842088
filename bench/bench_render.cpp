/// Frames a second of the paper's scenario, where the time of a frame goes, and what a still image takes.
/// Each benchmark states frames (or pixels) a second and thread; with two threads Google Benchmark gives the rate of
/// both.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <vector>

#include "render/film/clip_renderer.h"
#include "render/film/truth_files.h"
#include "render/paint/static_painter.h"
#include "render/video/video_writer.h"

namespace {

using namespace glidelab;
using namespace glidelab::render;

/// What all frames of one clip share, made once.
struct Stage {
  Scenario scenario = read_scenario(GLIDELAB_SOURCE_DIR "/scenarios/paper/inclined.toml");
  const sim::ConfigurationSetup& configuration = scenario.motion.configurations.back();
  RayTable rays = make_ray_table(scenario.camera);
  StaticScene scene = empty_track(scenario, configuration.body.incline_rad);
  FloatImage background_e;
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

/// What a tracker near the marker looks at: 64 x 64 pixels about it, where the whole of that is in the image.
void region_in_memory(benchmark::State& state) {
  const Stage& made = stage();
  ClipRenderer renderer = made.clip_renderer();
  constexpr int kSide = 64;
  std::vector<std::uint8_t> codes(kSide * kSide);
  std::vector<std::pair<const FrameMotion*, PixelRect>> seen;
  for (const FrameMotion& frame : made.frames) {
    const auto marker = marker_in_image(made.scenario, made.configuration.body, frame);
    if (!marker) continue;
    const PixelRect rect{static_cast<int>(marker->center_px.x()) - kSide / 2,
                         static_cast<int>(marker->center_px.y()) - kSide / 2, kSide, kSide};
    if (intersection(rect, made.all) == rect) seen.emplace_back(&frame, rect);
  }
  std::size_t k = 0;
  for (auto _ : state) {
    const auto& [frame, rect] = seen[k++ % seen.size()];
    renderer.read(*frame, rect, std::span<std::uint8_t>(codes));
    benchmark::DoNotOptimize(codes.data());
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()));
}
BENCHMARK(region_in_memory)->Unit(benchmark::kMicrosecond)->UseRealTime()->Threads(1)->Threads(2);

/// The same scene by a straightforward script, which is written here and run by python3 where it has numpy and OpenCV:
/// a still background, the glider's body and the marker filled with sub-pixel corners at a few instants of the
/// exposure, the lens by remap, Poisson and normal noise, rounding. The time is that of its own frames.
constexpr const char* kScript = R"(
import time, numpy as np, cv2
cv2.setNumThreads(1)
W, H, S = 800, 600, 4
rng = np.random.default_rng(1)
yy, xx = np.mgrid[0:H, 0:W].astype(np.float32)
background = 17000 + 3000 * np.sin(xx / 90) + 500 * np.sin(yy / 7)
x, y = (xx - 399.5) / 1200, (yy - 299.5) / 1200
r2 = x * x + y * y
d = 1 - 0.12 * r2 + 0.06 * r2 * r2
map_x, map_y = (x / d * 1200 + 399.5).astype(np.float32), (y / d * 1200 + 299.5).astype(np.float32)
def frame(u):
    picture = np.zeros((H, W), np.float32)
    for part in range(3):
        at = u + (part - 1) * 0.2
        layer = background.astype(np.float32).copy()
        def corners(a, b, c, e):
            return (np.array([[a, c], [b, c], [b, e], [a, e]]) * 256).round().astype(np.int32)
        cv2.fillPoly(layer, [corners(at - 33, at + 33, 291, 317)], 10000.0, cv2.LINE_8, 8)
        big = np.zeros((20 * S, 20 * S), np.float32)
        left = int(at) - 10
        cv2.circle(big, (int((at - left + 0.5) * S * 256), int(10 * S * 256)), int(5 * S * 256), 1.0, -1, cv2.LINE_8, 8)
        cover = cv2.resize(big, (20, 20), interpolation=cv2.INTER_AREA)
        patch = layer[290:310, left:left + 20]
        patch += cover * (50000 - patch)
        picture += layer / 3
    picture = cv2.remap(picture, map_x, map_y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    electrons = np.minimum(rng.poisson(picture), 60000) + rng.normal(0, 30, picture.shape)
    return np.clip(np.rint(electrons * (253.0 / 60000) + 2), 0, 255).astype(np.uint8)
frame(100.0)
count = 20
start = time.perf_counter()
for k in range(count):
    frame(100.0 + 3.7 * k)
print((time.perf_counter() - start) / count)
)";

void numpy_and_opencv_frame(benchmark::State& state) {
  const std::filesystem::path script = std::filesystem::temp_directory_path() / "glidelab-bench-frame.py";
  std::ofstream(script) << kScript;
  for (auto _ : state) {
    double seconds = 0.0;
    FILE* const out = popen(("python3 " + script.string() + " 2>/dev/null").c_str(), "r");
    const bool timed = out != nullptr && std::fscanf(out, "%lf", &seconds) == 1;
    if (out != nullptr) pclose(out);
    if (!timed) {
      state.SkipWithError("no python3 with numpy and OpenCV");
      break;
    }
    state.SetIterationTime(seconds);
  }
  std::filesystem::remove(script);
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()));
}
BENCHMARK(numpy_and_opencv_frame)->Unit(benchmark::kMillisecond)->UseManualTime()->Iterations(1);

void frames_to_file(benchmark::State& state) {
  const Stage& made = stage();
  ClipRenderer renderer = made.clip_renderer();
  const auto codec = static_cast<Codec>(state.range(0));
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() /
      ("glidelab-bench-" + std::to_string(state.thread_index()) + file_name_of(codec, ""));
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
  state.SetLabel(name_of(codec));
}
BENCHMARK(frames_to_file)
    ->Arg(static_cast<int>(Codec::magicyuv))
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

void still_image(benchmark::State& state) {
  const Stage& made = stage();
  StaticPainter painter(made.scenario.camera, made.rays);
  StaticScene scene = made.scene;
  scene.board = plane_board(made.scenario, 0);
  for (auto _ : state) benchmark::DoNotOptimize(painter.paint(scene));
}
BENCHMARK(still_image)->Unit(benchmark::kMillisecond)->UseRealTime();

void ray_table_of_the_lens(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(make_ray_table(stage().scenario.camera));
}
BENCHMARK(ray_table_of_the_lens)->Unit(benchmark::kMillisecond);

}  // namespace
