/// A folder of a test's own, removed with it.
#pragma once

#include "base/files/file_io.h"

namespace glidelab::tests {

struct TempDir : base::TemporaryFolder {
  TempDir() : TemporaryFolder("test") {}
};

}  // namespace glidelab::tests
