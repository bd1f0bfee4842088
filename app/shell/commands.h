/// The commands, one file each. add_…() declares a command's options; if the user chose it, `chosen` becomes its
/// work.
#pragma once

#include <functional>

namespace CLI {
class App;
}  // namespace CLI

namespace glidelab::app {

using Command = std::function<void()>;

void add_simulate(CLI::App& app, Command& chosen);
void add_render(CLI::App& app, Command& chosen);
void add_analyze(CLI::App& app, Command& chosen);
void add_validate(CLI::App& app, Command& chosen);
void add_coverage(CLI::App& app, Command& chosen);
void add_sweep(CLI::App& app, Command& chosen);
void add_require(CLI::App& app, Command& chosen);
void add_laws(CLI::App& app, Command& chosen);
void add_characterize(CLI::App& app, Command& chosen);
void add_diagnose(CLI::App& app, Command& chosen);
void add_blind(CLI::App& app, Command& chosen);
void add_new(CLI::App& app, Command& chosen);
void add_pattern(CLI::App& app, Command& chosen);
void add_check(CLI::App& app, Command& chosen);
void add_explore(CLI::App& app, Command& chosen);

}  // namespace glidelab::app
