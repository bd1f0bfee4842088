#include "diagnose/effects/stage.h"

namespace glidelab::diagnose {

std::string_view to_text(Stage stage) {
  switch (stage) {
    case Stage::dynamics:
      return "dynamics";
    case Stage::optics:
      return "optics";
    case Stage::timing:
      return "timing";
    case Stage::sensor:
      return "sensor";
    case Stage::tracking:
      return "tracking";
    case Stage::analysis:
      break;
  }
  return "analysis";
}

}  // namespace glidelab::diagnose
