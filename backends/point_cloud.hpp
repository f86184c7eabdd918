#pragma once
// What a sum needs to know about its points before it starts: that they are numbers, where they lie, and
// whether some of them nearly touch.

#include "base/arrays.hpp"

namespace asterflow {

struct Bounds {
  Vec3d lower{}, upper{};
  Vec3d centre() const { return 0.5 * (lower + upper); }
  double extent() const;  // longest edge
};

// Smallest box around sources and targets. Throws SceneError when a coordinate is not finite or beyond 1e100.
Bounds bounding_box(ConstPoints sources, ConstPoints targets);

// Whether the points reach so much farther than the sources are apart (or a lone source from the nearest target) that
// distances between sources, scaled with all the rest, would count as none.
bool dwarfs_sources(Bounds const& all, ConstPoints sources, ConstPoints targets);

// True when two different points of the union are closer than `distance` > 0; coincident points do not count.
// Takes O(n log n); may answer true without need when very many points project onto the same place.
bool has_close_pair(ConstPoints sources, ConstPoints targets, double distance);

}  // namespace asterflow
