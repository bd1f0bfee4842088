/// The folders that stand only while this process works in them (staging and temporary ones), for an end without
/// unwinding: a signal while a library computes for long.
#pragma once

#include <filesystem>

namespace glidelab::base {

void remember_passing_folder(const std::filesystem::path& folder);
void forget_passing_folder(const std::filesystem::path& folder);

/// From now on results are being put in place, and the process ends by itself.
void begin_publishing();

/// Removes the remembered folders, as far as other threads let it; false, and nothing is removed, once
/// begin_publishing() was called. Whoever wants to publish after this waits: the process is about to end.
bool discard_passing_folders();

}  // namespace glidelab::base
