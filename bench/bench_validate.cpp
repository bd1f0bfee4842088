/// The fit of the whole motion to the paper's twelve clips, and the same fit by scipy where python3 has it.
#include <benchmark/benchmark.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/long_work.h"
#include "fit/trajectory/trajectory_results.h"
#include "render/film/clip_renderer.h"
#include "validate/film/film_studio.h"
#include "validate/made_tracks/made_tracks.h"
#include "validate/study/coverage/interval_coverage.h"
#include "validate/study/sweep/one_run.h"

namespace {

using namespace glidelab;

constexpr double kNoise = 3e-5;  // m, as the images of the scenarios give it

struct Made {
  validate::MadeTracks noisy;
  core::AnalysisResults lines;
};

/// Level and inclined: 12 clips, 4000 frames.
const std::vector<Made>& paper() {
  static const std::vector<Made> made = [] {
    std::vector<Made> all;
    for (const char* name : {"level", "inclined"}) {
      const render::Scenario scenario =
          render::read_scenario(std::string(GLIDELAB_SOURCE_DIR) + "/scenarios/paper/" + name + ".toml");
      Made one{validate::with_noise(validate::make_tracks(scenario, 1), kNoise, 1), {}};
      one.lines = validate::analyze_tracks(one.noisy, std::optional<double>());
      all.push_back(std::move(one));
    }
    return all;
  }();
  return made;
}

void trajectory_fit_of_twelve_clips(benchmark::State& state) {
  std::size_t points = 0;
  for (const Made& made : paper()) {
    for (const core::TrackData& track : made.noisy.tracks) points += track.x_m.size();
  }
  for (auto _ : state) {
    for (const Made& made : paper()) benchmark::DoNotOptimize(fit::with_trajectory_fits(made.lines));
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()) * static_cast<std::int64_t>(points));
}
BENCHMARK(trajectory_fit_of_twelve_clips)->Unit(benchmark::kMillisecond);

void phase_diagram_of_twelve_clips(benchmark::State& state) {
  for (auto _ : state) {
    for (const Made& made : paper())
      benchmark::DoNotOptimize(validate::analyze_tracks(made.noisy, std::optional<double>()));
  }
}
BENCHMARK(phase_diagram_of_twelve_clips)->Unit(benchmark::kMillisecond);

/// The same least-squares problem as somebody would write it: solve_ivp with an event at v = 0, least_squares with
/// differences. Reads "configuration clip t x" lines; prints the seconds of the fits alone.
constexpr const char* kScript = R"(
import sys, time
import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import least_squares
clips = {}
for line in open(sys.argv[1]):
    c, n, t, x = line.split()
    clips.setdefault(c, {}).setdefault(n, []).append((float(t), float(x)))
clips = {c: [np.array(v).T for v in by.values()] for c, by in clips.items()}
def stop(t, y, *a): return y[1]
stop.terminal = True
def motion(k, d, f, x0, v0, t):
    out, t0, y0 = np.empty(len(t)), t[0], [x0, v0]
    s, i = np.sign(v0), 0
    for _ in range(2):
        rate = lambda t, y: [y[1], d - k * y[1] - s * f]
        stop.direction = -s
        r = solve_ivp(rate, (t0, t[-1]), y0, t_eval=t[i:], events=stop, rtol=1e-9, atol=1e-11)
        n = len(r.t)
        out[i:i + n] = r.y[0][:n]
        i += n
        if r.status != 1: break
        t0, y0, s = r.t_events[0][0], [r.y_events[0][0][0], 0.0], -s
        if abs(d) <= f:
            out[i:] = y0[0]
            break
    return out
def residual(p, data):
    return np.concatenate([motion(*p[:3], *p[3 + 2 * i:5 + 2 * i], t) - x for i, (t, x) in enumerate(data)])
start = time.perf_counter()
for data in clips.values():
    p = [2.5, 0.0 if 'level' in sys.argv[2] else 0.73, 0.05]
    for t, x in data:
        p += [x[0], np.polyfit(t[:15], x[:15], 1)[0]]
    least_squares(residual, p, args=(data,), x_scale='jac')
print(time.perf_counter() - start)
)";

void scipy_fit_of_twelve_clips(benchmark::State& state) {
  const std::filesystem::path dir = std::filesystem::temp_directory_path();
  const std::filesystem::path script = dir / "glidelab-bench-fit.py", data = dir / "glidelab-bench-fit.txt";
  std::ofstream(script) << kScript;
  for (auto _ : state) {
    double seconds = 0.0;
    for (const char* kind : {"level", "inclined"}) {
      const Made& made = paper()[std::string(kind) == "level" ? 0 : 1];
      {
        std::ofstream file(data);
        file.precision(17);
        for (std::size_t c = 0; c < made.lines.clips.size(); ++c) {
          const core::ClipResult& clip = made.lines.clips[c];
          for (const core::FreeBlock& block : clip.blocks) {
            for (std::size_t i = 0; i < block.t_s.size(); ++i) {
              file << made.noisy.truth.clips[c].configuration << ' ' << clip.name << ' ' << block.t_s[i] << ' '
                   << block.x_m[i] << '\n';
            }
          }
        }
      }
      const std::string command = "python3 " + script.string() + " " + data.string() + " " + kind + " 2>/dev/null";
      double part = 0.0;
      FILE* const out = popen(command.c_str(), "r");
      const bool timed = out != nullptr && std::fscanf(out, "%lf", &part) == 1;
      if (out != nullptr) pclose(out);
      if (!timed) {
        state.SkipWithError("no python3 with scipy");
        break;
      }
      seconds += part;
    }
    state.SetIterationTime(seconds);
  }
  std::filesystem::remove(script);
  std::filesystem::remove(data);
}
BENCHMARK(scipy_fit_of_twelve_clips)->Unit(benchmark::kMillisecond)->UseManualTime()->Iterations(1);

/// The paper's inclined experiment with clips of 2 s (400 frames of 800 x 600), `copies` of each of its six.
render::Scenario two_second_clips(std::int64_t copies) {
  render::Scenario scenario = render::read_scenario(GLIDELAB_SOURCE_DIR "/scenarios/paper/inclined.toml");
  for (sim::ConfigurationSetup& configuration : scenario.motion.configurations) {
    const std::vector<sim::MotionSetup> once = std::exchange(configuration.motions, {});
    for (std::int64_t copy = 0; copy < copies; ++copy) {
      for (sim::MotionSetup motion : once) {
        motion.duration_s = 2.0;
        motion.name.append("-").append(std::to_string(copy));
        configuration.motions.push_back(motion);
      }
    }
  }
  return scenario;
}

/// What a sweep of rendered clips does with two jobs: two experiments of 24 clips at once, each on a thread of its own;
/// every clip simulated, drawn and tracked in memory, and both estimators. Clips a second by the clock on the wall, and
/// by the processor time of both threads, in which other work on the machine does not count: clips / (time / 2).
/// Without stills the camera is calibrated and what stands still is drawn once, beforehand; with them each experiment
/// has its own.
void clips_through_the_whole_chain(benchmark::State& state) {
  const bool with_stills = state.range(0) != 0;
  const render::Scenario scenario = two_second_clips(4);
  std::vector<std::unique_ptr<validate::FilmStudio>> studios(2);
  if (!with_stills) {
    const auto stage = render::set_stage(scenario, 2);
    for (auto& studio : studios) studio = std::make_unique<validate::FilmStudio>(scenario, 1, 2, stage);
  }
  std::uint64_t seed = 0;
  std::atomic<std::int64_t> clips = 0;
  double wall_s = 0.0, processor_s = 0.0;
  for (auto _ : state) {
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t processor_start = std::clock();
    base::for_each_parallel(studios.size(), 2, [&](std::size_t i) {
      const validate::MadeTracks made =
          studios[i] ? studios[i]->film(scenario, seed + i, 1) : validate::film_tracks(scenario, seed + i, 1);
      benchmark::DoNotOptimize(fit::with_trajectory_fits(validate::analyze_tracks(made, core::MotionOptions{})));
      clips += std::ssize(made.tracks);
    });
    seed += studios.size();
    wall_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    processor_s += 0.5 * static_cast<double>(std::clock() - processor_start) / CLOCKS_PER_SEC;
  }
  state.counters["clips/s"] = static_cast<double>(clips) / wall_s;
  state.counters["by processor time"] = static_cast<double>(clips) / processor_s;
  state.SetLabel(with_stills ? "stills and calibration each time" : "calibrated once");
}
BENCHMARK(clips_through_the_whole_chain)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(2);

}  // namespace
