// The local cubic, per point: uniform times are filtered, others fitted point by point. And a clip's whole analysis.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "core/motion/analyze_motion.h"
#include "core/motion/smoothing/local_polynomial.h"

namespace {

using namespace glidelab;

struct Series {
  std::vector<double> t_s, x_m;
};

/// The paper's m1 at 4 degrees sliding down from 1.2 m/s, at 200 Hz; with `jitter` every step is off by up to 20 %.
Series series(std::size_t count, double jitter) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0.0, 1e-5);
  std::uniform_real_distribution<double> off(-0.2, 0.2);
  Series made;
  for (std::size_t i = 0; i < count; ++i) {
    const double t = 0.005 * (static_cast<double>(i) + jitter * off(random));
    made.t_s.push_back(t);
    made.x_m.push_back(0.24 * t - 0.35 * std::expm1(-2.77 * t) + noise(random));
  }
  return made;
}

void smooth(benchmark::State& state, double jitter) {
  const Series made = series(static_cast<std::size_t>(state.range(0)), jitter);
  const double bandwidth_s = 0.001 * static_cast<double>(state.range(1));
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(core::LocalCubic(made.t_s, bandwidth_s).smooth(made.x_m));
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

void local_cubic_uniform(benchmark::State& state) {
  smooth(state, 0.0);
}
void local_cubic_irregular(benchmark::State& state) {
  smooth(state, 1.0);
}
BENCHMARK(local_cubic_uniform)
    ->ArgNames({"points", "h_ms"})
    ->Args({1000000, 43})
    ->Args({1000000, 100})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(local_cubic_irregular)->ArgNames({"points", "h_ms"})->Args({100000, 43})->Unit(benchmark::kMillisecond);

/// What a user of R would take: KernSmooth's locpoly(drv = 2, degree = 3) on a grid of as many points. The time is R's
/// own count of processor time.
void r_locpoly(benchmark::State& state) {
  const std::filesystem::path script = std::filesystem::temp_directory_path() / "glidelab-bench-locpoly.R";
  std::ofstream(script) << "suppressMessages(library(KernSmooth)); n <- " << state.range(0)
                        << "; t <- 0.005 * (0:(n - 1)); x <- 0.24 * t - 0.35 * expm1(-2.77 * t) + 1e-5 * rnorm(n);"
                        << "took <- system.time(locpoly(t, x, drv = 2, degree = 3, bandwidth = "
                        << 0.001 * static_cast<double>(state.range(1))
                        << ", gridsize = n, range.x = range(t))); cat(took[[1]] + took[[2]])\n";
  for (auto _ : state) {
    double seconds = 0.0;
    FILE* const out = popen(("Rscript " + script.string() + " 2>/dev/null").c_str(), "r");
    const bool timed = out != nullptr && std::fscanf(out, "%lf", &seconds) == 1;
    if (out != nullptr) pclose(out);
    if (!timed) {
      state.SkipWithError("no Rscript with KernSmooth");
      break;
    }
    state.SetIterationTime(seconds);
  }
  std::filesystem::remove(script);
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(r_locpoly)
    ->ArgNames({"points", "h_ms"})
    ->Args({1000000, 43})
    ->Args({1000000, 100})
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->Iterations(1);

void analyze_clip(benchmark::State& state) {
  const Series made = series(341, 0.0);
  core::TrackData track;
  track.t_s = track.frame_t_s = made.t_s;
  track.x_m = made.x_m;
  for (std::size_t i = 0; i < made.t_s.size(); ++i) track.frame.push_back(i);
  track.frame_rate_hz = 200.0;
  core::ClipSetup setup;
  setup.name = "down";
  setup.mass_kg = 0.335;
  setup.incline_rad = 0.07;
  setup.launched = core::Launched::down;
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(core::analyze_motion(setup, track, core::MotionOptions{}));
  }
  state.SetItemsProcessed(state.iterations() * 341);
}
BENCHMARK(analyze_clip)->Unit(benchmark::kMillisecond);

}  // namespace
