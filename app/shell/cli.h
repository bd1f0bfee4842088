/// The program: reads the command line, runs the command, and turns what it throws into an exit status.
///
///     0 done, 1 wrong input, 2 wrong command line, 3 the environment failed, 4 a requirement is not met,
///     130 interrupted
#pragma once

namespace glidelab::app {

/// Everything that main() does.
int run(int argc, char** argv);

}  // namespace glidelab::app
