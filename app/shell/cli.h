/// The program: it reads the command line, runs one command, and turns its exceptions into an exit status.
///
///     0 done, 1 wrong input, 2 wrong command line, 3 the environment failed, 4 a requirement is not met,
///     130 interrupted
#pragma once

#include <functional>

namespace CLI {
class App;
}  // namespace CLI

namespace glidelab::app {

/// The work of a command. The commands are one file each; add_…() declares a command's options, and if the user chose
/// it, `chosen` becomes its work.
using Command = std::function<void()>;

void add_simulate(CLI::App& app, Command& chosen);
void add_render(CLI::App& app, Command& chosen);
void add_analyze(CLI::App& app, Command& chosen);
void add_validate(CLI::App& app, Command& chosen);
void add_coverage(CLI::App& app, Command& chosen);
void add_certify(CLI::App& app, Command& chosen);
void add_sweep(CLI::App& app, Command& chosen);
void add_require(CLI::App& app, Command& chosen);
void add_laws(CLI::App& app, Command& chosen);
void add_characterize(CLI::App& app, Command& chosen);
void add_diagnose(CLI::App& app, Command& chosen);
void add_blind(CLI::App& app, Command& chosen);
void add_challenge(CLI::App& app, Command& chosen);
void add_new(CLI::App& app, Command& chosen);
void add_pattern(CLI::App& app, Command& chosen);
void add_check(CLI::App& app, Command& chosen);
void add_explore(CLI::App& app, Command& chosen);

/// Everything that main() does.
int run(int argc, char** argv);

}  // namespace glidelab::app
