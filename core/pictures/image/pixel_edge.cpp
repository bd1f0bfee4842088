#include "core/pictures/image/pixel_edge.h"

#include <numbers>

namespace glidelab::core {

NormalNodes make_normal_nodes() {
  NormalNodes nodes;
  for (int i = 0; i < NormalNodes::kCount; ++i) {
    const double z = static_cast<double>(i) / kNormalNodesPerUnit - kFarFromEdge;
    const auto at = static_cast<std::size_t>(i);
    nodes.density[at] = std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi);
    nodes.distribution[at] = 0.5 * std::erfc(-z * (1.0 / std::numbers::sqrt2));
  }
  nodes.density.front() = nodes.distribution.front() = nodes.density.back() = 0.0;
  nodes.distribution.back() = 1.0;
  return nodes;
}

PixelEdge pixel_edge(double s, double nu, double nv, double blur) {
  static const NormalNodes nodes = make_normal_nodes();
  const EdgeBoxes boxes = edge_boxes(nu, nv, blur);
  return edge_of(boxes, edge_corners(nodes, s, boxes));
}

}  // namespace glidelab::core
