#include "backends/fast_tree.hpp"

#include "backends/blocks.hpp"

#include <algorithm>

namespace asterflow {

Octree::Octree(ConstPoints sources, ConstPoints targets, OctreeOptions const& options)
    : is_self_(is_same(sources, targets)),
      cube_(sources, targets, options.enlargement),
      first_level_(options.first_level),
      sources_(order_points(sources, cube_)) {
  if (!is_self_) targets_ = order_points(targets, cube_);
  boxes_ = OctreeBoxes(sources_.keys, is_self_ ? sources_.keys : targets_.keys, options);
  sources_.keys = {};
  targets_.keys = {};
}

std::size_t Octree::memory() const {
  return sizeof(Vec3d) * (sources_.points.capacity() + targets_.points.capacity()) +
         sizeof(std::uint32_t) * (sources_.order.capacity() + targets_.order.capacity()) + boxes_.memory();
}

void Octree::reorder_targets(Range leaf, std::vector<std::uint32_t> const& order) {
  OrderedPoints& reordered = is_self_ ? sources_ : targets_;
  PointArray points(leaf.size());
  std::vector<std::uint32_t> originals(leaf.size());
  for (long i = 0; i < leaf.size(); ++i) {
    points[i] = reordered.points[order[i]];
    originals[i] = reordered.order[order[i]];
  }
  std::copy(points.begin(), points.end(), reordered.points.begin() + leaf.begin);
  std::copy(originals.begin(), originals.end(), reordered.order.begin() + leaf.begin);
}

PointArray Octree::sorted(ConstPoints of_sources) const {
  PointArray result(of_sources.size());
  for_blocks("Octree::sorted", static_cast<long>(result.size()), [&](long i) { result[i] = of_sources[sources_.order[i]]; });
  return result;
}

}  // namespace asterflow
