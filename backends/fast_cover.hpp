#pragma once
// Covers the refined boxes of one level by disjoint rectangular patches, each to be transformed at once.
// A patch of m boxes per direction needs a grid of m + 2 boxes: large patches waste less margin, small
// ones less empty space. The cheapest set found by halving the bounding rectangle recursively is taken.

#include "backends/fast_boxes.hpp"

namespace asterflow {

struct Rectangle {
  int low[3], high[3];             // places of the boxes, inclusive
  std::vector<Box const*> boxes;   // the refined boxes inside
};

// nodes_per_box: grid nodes along the side of a box; max_nodes: largest grid of a patch.
std::vector<Rectangle> cover(std::vector<Box const*> boxes, double nodes_per_box, double max_nodes);

}  // namespace asterflow
