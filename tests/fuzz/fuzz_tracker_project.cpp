/// A project of Tracker, as XML or in an archive. The first byte chooses the point mass and the direction.
#include "core/track/tracker_project.h"
#include "tests/fuzz/fuzz_target.h"

using namespace glidelab;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::InputFolder folder;
  static const std::string kMasses[] = {"", "1", "mass A", "a.trk: mass A"};
  using Direction = std::optional<core::Downhill>;
  static const Direction kDirections[] = {Direction(), core::Downhill::minus_x, core::Downhill::plus_y};
  if (size == 0) return 0;
  const auto file = folder.with("made.trz", data + 1, size - 1);
  return fuzz::read_or_refuse([&] {
    core::read_tracker_project(file, kDirections[*data % std::size(kDirections)],
                               kMasses[*data / 4 % std::size(kMasses)]);
  });
}
