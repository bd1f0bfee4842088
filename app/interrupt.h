/// SIGINT, SIGTERM and SIGHUP set a flag; the work looks at it and ends by itself, cleaning up behind it.
#pragma once

namespace glidelab::app {

/// From now on those signals set the flag. Writing beyond a size limit or to a closed pipe becomes an error that the
/// write reports and no longer ends the process.
void catch_interrupts();

bool interrupted();

/// Throws base::Interrupted where the flag is set.
void throw_if_interrupted();

}  // namespace glidelab::app
