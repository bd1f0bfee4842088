#include "app/shell/build_version.h"

#include "version_of_build.h"

namespace glidelab::app {

std::string build_version() {
  return GLIDELAB_VERSION;
}

std::string version_text() {
  return "glidelab " GLIDELAB_VERSION "\nbuilt with " GLIDELAB_LIBRARIES;
}

}  // namespace glidelab::app
