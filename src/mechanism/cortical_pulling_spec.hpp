#pragma once
// Motors on the cortex that capture and pull plus ends: the table [cortical_pulling].

#include "base/table.hpp"

#include <string>
#include <vector>

namespace asterflow {

struct CorticalPullingSpec {
  enum class Direction { fiber, normal };
  enum class Arrangement { random, even };

  int sites = 100;               // >= 0, spread over the cortex, uniformly by area,
  Arrangement arrangement = Arrangement::random;  // each at random or evenly (mechanism/cortical_sites.hpp); or
  std::vector<Vec3d> positions = {};  // um, of the sites, on the cortex
  double pull_force = 3.0;       // pN, >= 0, outwards on a captured plus end
  Direction direction = Direction::fiber;  // of the pull: along the fiber's tangent or the cortex' outward normal
  double residence_time = 20.0;  // s, > 0: mean time until a captured plus end is let go
  double reach = 2.0;            // um, > 0: a site captures plus ends that are so close
  double capture_rate = 1.0;     // k, 1/s, >= 0: of a free site for a plus end in reach, on the anterior side

  Vec3d posterior{1, 0, 0};            // direction from the centre of the cell to its posterior pole
  double posterior_pole_factor = 1.5;  // capture rate over k at the posterior pole, >= 0
  double posterior_plane_factor = 0.5; // the same just posterior of the dividing plane; linear between, >= 0
  std::string dividing_body = {};      // the plane goes through the centre of this body; or
  double dividing_plane = 0.0;         // um, fixed, along `posterior`
};

CorticalPullingSpec read_cortical_pulling(Table table);

}  // namespace asterflow
