/// Runs one target over the files and folders named on the command line; what an input does wrong ends the program.
#include <cstdio>

#include "tests/fuzz/fuzz_target.h"

int main(int argc, char** argv) {
  namespace fs = std::filesystem;
  std::size_t inputs = 0;
  const auto run = [&inputs](const fs::path& file) {
    std::fprintf(stderr, "%s\n", file.c_str());
    const std::string bytes = glidelab::base::read_file(file);
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    ++inputs;
  };
  for (int i = 1; i < argc; ++i) {
    if (!fs::is_directory(argv[i]))
      run(argv[i]);
    else
      for (const auto& entry : fs::directory_iterator(argv[i])) run(entry.path());
  }
  std::fprintf(stderr, "%zu inputs\n", inputs);
  return inputs == 0 ? 1 : 0;
}
