/// Values put into a document at dotted paths: the path is the first line, the document is the rest. What comes out is
/// TOML again.
#include "base/toml/strict_toml.h"
#include "base/toml/toml_set.h"
#include "tests/fuzz/fuzz_target.h"

using namespace glidelab;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = fuzz::text_of(data, size);
  const std::size_t end = text.find('\n');
  if (end == std::string_view::npos) return 0;
  return fuzz::read_or_refuse([&] {
    const std::string changed =
        base::with_values(text.substr(end + 1), "document", {{std::string(text.substr(0, end)), 0.25}});
    try {
      base::TomlFile::parse(changed, "changed");
    } catch (const base::InputError&) {
      __builtin_trap();
    }
  });
}
