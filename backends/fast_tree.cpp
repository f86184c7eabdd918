#include "backends/fast_tree.hpp"

#include <algorithm>

namespace asterflow {

Octree::Octree(ConstPoints sources, ConstPoints targets, OctreeOptions const& options)
    : cube_(sources, targets, options.enlargement), first_level_(options.first_level), sources_(order_points(sources, cube_)) {
  bool const same = is_same(sources, targets);
  if (!same) targets_ = order_points(targets, cube_);
  boxes_ = OctreeBoxes(sources_.keys, same ? sources_.keys : targets_.keys, options);
  sources_.keys = {};
  targets_.keys = {};
  if (same) targets_ = sources_;
}

std::size_t Octree::memory() const {
  return sizeof(Vec3d) * (sources_.points.capacity() + targets_.points.capacity()) +
         sizeof(std::uint32_t) * (sources_.order.capacity() + targets_.order.capacity()) + boxes_.memory();
}

void Octree::reorder_targets(Range leaf, std::vector<std::uint32_t> const& order) {
  PointArray points(leaf.size());
  std::vector<std::uint32_t> originals(leaf.size());
  for (long i = 0; i < leaf.size(); ++i) {
    points[i] = targets_.points[order[i]];
    originals[i] = targets_.order[order[i]];
  }
  std::copy(points.begin(), points.end(), targets_.points.begin() + leaf.begin);
  std::copy(originals.begin(), originals.end(), targets_.order.begin() + leaf.begin);
}

}  // namespace asterflow
