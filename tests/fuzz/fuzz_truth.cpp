/// truth.json with the trajectory that the seed names.
#include "validate/truth/truth_folder.h"

#include "tests/fuzz/fuzz_target.h"

using namespace glidelab;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::InputFolder folder(
      {}, {{"trajectory-up.csv", "t_s,x_m,v_m_s,a_m_s2,mode\n0,0.1,1,0,slide_down\n0.005,0.105,1,0,stick\n"}});
  folder.with("truth.json", data, size);
  return fuzz::read_or_refuse([&] { validate::read_truth(folder.path()); });
}
