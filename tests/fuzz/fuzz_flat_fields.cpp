/// characterize.toml, in a folder with the least sets of frames.
#include "core/characterize/flat_field_folder.h"
#include "tests/fuzz/fuzz_target.h"

using namespace glidelab;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::InputFolder folder({"dark/0.png", "dark/1.png", "dark-10ms/0.png", "dark-10ms/1.png",
                                         "flat-00/0.png", "flat-00/1.png", "flat-01/0.png", "flat-01/1.png"});
  folder.with("characterize.toml", data, size);
  return fuzz::read_or_refuse([&] { core::read_flat_field_folder(folder.path()); });
}
