#include "app/commands/baseline_gate.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "app/shell/run_control.h"
#include "base/errors.h"
#include "base/files/file_io.h"
#include "render/scenario/scenario.h"
#include "report/text/outside_text.h"
#include "report/validation/gate_text.h"
#include "validate/study/baseline/gate.h"

namespace glidelab::app {

namespace fs = std::filesystem;

void run_baseline_gate(const BaselineGate& gate, const CommonOptions& common, const std::string& scenario_file,
                       const std::optional<fit::OutsideEstimator>& outside) {
  if (!gate.write.empty()) {
    check_file_writable(gate.write);
    check_own_file(gate.write, "--write-baseline", "{");
    std::error_code error;  // of a file that does not exist
    if (!gate.compare.empty() && fs::equivalent(gate.compare, gate.write, error)) {
      throw base::InputError(base::Issue{gate.write, 0, "--write-baseline", "the file of --baseline",
                                         "another file: the baseline of the comparison is not overwritten"});
    }
  }
  const std::string text = base::read_file(scenario_file);
  const render::Scenario scenario = render::read_scenario(text, scenario_file, render::ScenarioChecks::values);
  validate::GateOptions options;
  options.baseline = gate.compare;
  options.noise_m = gate.noise_m;
  options.seed = common.seed;
  options.runs = gate.runs;
  options.jobs = common.jobs;
  options.outside = outside;
  ProgressDisplay display(common.quiet, common.verbose);
  validate::Gate found = validate::run_gate(scenario, text, scenario_file, options, display.callback());
  display.clear();
  throw_if_interrupted();
  print_result(common.json ? validate::baseline_json(found.now) : report::errors_table(found.now));
  if (found.outside) say(common, report::outside_text(*found.outside));
  if (!gate.write.empty()) write_whole(gate.write, validate::baseline_json(found.now));
  if (!found.then) return;
  found = validate::compared(std::move(found));
  say(common, report::power_text(*found.comparison));
  say(common, report::detectable_text(found));
  if (const std::string weak = report::weak_text(found); !weak.empty()) say(common, weak);
  const std::string worse = report::worse_text(*found.comparison);
  if (worse.empty()) {
    say(common, "nothing is worse than the baseline");
    return;
  }
  throw base::NotMet(fmt::format("worse than {}:\n{}", gate.compare, worse));
}

}  // namespace glidelab::app
