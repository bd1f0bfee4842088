// Wall time of the true motion, per second of motion: `items_per_second` is seconds of motion per second of wall time.
#include <benchmark/benchmark.h>

#include <memory>
#include <vector>

#include "sim/force/law_list.h"
#include "sim/motion/simulate.h"

namespace {

using namespace glidelab;

constexpr double kDuration = 1.7;  // s, as the paper's clips

// The paper's m1 at 4 degrees (Tables 3 and 4), launched uphill: one reversal.
sim::Body paper_body() {
  sim::Body body;
  body.mass_kg = 0.335;
  body.incline_rad = 0.07524;
  body.forces = {sim::laws::viscous().with({0.927}), sim::laws::coulomb().with({0.0071})};
  return body;
}

// `per_frame` instants in each of 340 frames: 1 for a trajectory, 16 for the instants within an exposure.
void simulate_clip(benchmark::State& state) {
  const auto per_frame = static_cast<int>(state.range(0));
  std::vector<double> times_s;
  times_s.reserve(340U * static_cast<std::size_t>(per_frame));
  for (int i = 0; i < 340 * per_frame; ++i) times_s.push_back(kDuration * i / (340.0 * per_frame));
  const sim::Body body = paper_body();
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(sim::simulate(body, 0.2, -1.3, times_s));
  state.counters["motion_s_per_s"] =
      benchmark::Counter(kDuration, benchmark::Counter::kIsIterationInvariantRate, benchmark::Counter::kIs1000);
}
BENCHMARK(simulate_clip)->Arg(1)->Arg(16)->Unit(benchmark::kMicrosecond);

}  // namespace
