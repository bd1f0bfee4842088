#include "sim/force/law_list.h"

#include <array>

namespace glidelab::sim {

std::span<const ForceLaw* const> force_laws() {
#define GLIDELAB_LIST_LAW(id) &laws::id(),
  static const std::array all = {GLIDELAB_FORCE_LAWS(GLIDELAB_LIST_LAW)};
#undef GLIDELAB_LIST_LAW
  return all;
}

}  // namespace glidelab::sim
