/// What every fuzz target shares: a reader may make a value of any bytes, or refuse them by an InputError; nothing
/// else.
///
/// A target is one file that defines LLVMFuzzerTestOneInput by read_or_refuse(). Built with clang and GLIDELAB_FUZZ=ON
/// libFuzzer drives it (tools/fuzz); built otherwise replay.cpp runs it over its corpus, which is a ctest. Any other
/// exception than those allowed leaves the function and ends the program, as does a sanitizer's finding.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "base/files/file_io.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace glidelab::fuzz {

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return size == 0 ? std::string_view{} : std::string_view(reinterpret_cast<const char*>(data), size);
}

/// A refusal has to say something, and no more than a person reads: a file must not fill a terminal.
/// With GLIDELAB_FUZZ_SHOW set it is printed.
inline void check_message(const std::exception& error) {
  const std::string_view message = error.what();
  if (message.empty() || message.size() > 1'000'000) __builtin_trap();
  static const bool show = std::getenv("GLIDELAB_FUZZ_SHOW") != nullptr;
  if (show) std::fprintf(stderr, "  refused: %s\n", error.what());
}

/// Runs `read`; an InputError, or one of `Allowed` besides, is an outcome like any other.
template <class... Allowed, class Read>
int read_or_refuse(Read&& read) {
  if constexpr (sizeof...(Allowed) == 0) {
    try {
      read();
    } catch (const base::InputError& error) {
      check_message(error);
    }
  } else {
    []<class First, class... Rest>(Read& inner, First*, Rest*...) {
      try {
        read_or_refuse<Rest...>(inner);
      } catch (const First& error) {
        check_message(error);
      }
    }(read, static_cast<Allowed*>(nullptr)...);
  }
  return 0;
}

/// A folder that lives as long as the program, with the input as one file in it, and files beside it for readers that
/// look whether they are there.
class InputFolder {
 public:
  using Texts = std::vector<std::pair<std::string, std::string_view>>;
  explicit InputFolder(const std::vector<std::string>& files = {}, const Texts& texts = {}) : folder_("fuzz") {
    for (const std::string& name : files) add(name, "x");
    for (const auto& [name, text] : texts) add(name, text);
  }
  const std::filesystem::path& path() const { return folder_.path(); }
  std::filesystem::path with(const std::string& name, const std::uint8_t* data, std::size_t size) const {
    base::write_file(path() / name, text_of(data, size));
    return path() / name;
  }

 private:
  void add(const std::string& name, std::string_view text) const {
    std::filesystem::create_directories((path() / name).parent_path());
    base::write_file(path() / name, text);
  }
  base::TemporaryFolder folder_;
};

}  // namespace glidelab::fuzz
