#pragma once
// Adaptive octree over sources and targets, with its points in the order of the Morton curve.

#include "backends/fast_boxes.hpp"

namespace asterflow {

class Octree {
 public:
  // All coordinates finite, at least one source and one target.
  Octree(ConstPoints sources, ConstPoints targets, OctreeOptions const& options);

  double side() const { return cube_.side; }                     // of the root, in the units of the points given
  PointArray const& sources() const { return sources_.points; }  // sorted
  PointArray const& targets() const { return is_self_ ? sources_.points : targets_.points; }
  bool is_self() const { return is_self_; }                      // sources and targets are the same points, in one order
  Vec3d corner() const { return cube_.corner; }                  // of the root, in the units of these
  double unit_side() const { return cube_.unit_side; }           // likewise its side, 0.5 ... 1
  Vec3d normalised(Vec3d x) const { return cube_.normalised(x); }  // to the unit cube
  std::vector<std::uint32_t> const& source_order() const { return sources_.order; }  // original index of each
  std::vector<std::uint32_t> const& target_order() const { return is_self_ ? sources_.order : targets_.order; }
  int first_level() const { return first_level_; }
  Vec3d extent() const { return cube_.extent; }                  // of all points, normalised
  double largest_distance() const { return cube_.largest_distance; }  // no two points are farther apart, normalised
  OctreeBoxes const& boxes() const { return boxes_; }
  std::size_t memory() const;

  // Exchanges the order of the targets of one leaf, with the sources where they are the same points; `order` lists their
  // present positions.
  void reorder_targets(Range leaf, std::vector<std::uint32_t> const& order);

  // Numbers of the sources as given in their present order.
  PointArray sorted(ConstPoints of_sources) const;

 private:
  bool is_self_;
  RootCube cube_;
  int first_level_;
  OrderedPoints sources_, targets_;  // targets only where they differ; keys are dropped once there are boxes
  OctreeBoxes boxes_;
};

}  // namespace asterflow
