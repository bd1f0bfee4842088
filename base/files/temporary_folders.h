/// The folders that exist only while this process works in them (staging and temporary ones). They are remembered for
/// an exit without unwinding: a signal during a library's long computation.
#pragma once

#include <filesystem>
#include <vector>

namespace glidelab::base {

/// `parents`: folders above it that were made for it, deepest first, and that go with it where nothing else is in them.
void remember_temporary_folder(const std::filesystem::path& folder,
                               const std::vector<std::filesystem::path>& parents = {});
void forget_temporary_folder(const std::filesystem::path& folder);

/// Removes those of these folders that are empty; what is none, or is not empty, stays.
void remove_empty_folders(const std::vector<std::filesystem::path>& folders);

/// From now on results are being put in place; the process then ends by itself.
void begin_publishing();

/// Removes the remembered folders, as far as other threads allow. Once begin_publishing() has been called, it removes
/// nothing and returns false. A thread that wants to publish after this waits: the process is about to end.
bool discard_temporary_folders();

}  // namespace glidelab::base
