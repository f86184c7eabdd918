#pragma once
// Fibers as a scene describes them: a single one, [[fiber]], or an aster, [[aster]], a centrosome with many.

#include "base/arrays.hpp"
#include "base/table.hpp"
#include "fiber/fiber_ends.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace asterflow {

// What every fiber has.
struct FiberMaterialSpec {
  double bending_rigidity = 10.0;       // pN um^2, > 0
  double radius = 0.0125;               // um, > 0
  int nodes = 0;                        // hydrodynamic nodes, 6 to 64; 0: from its length and the accuracy of the run
  MinusEnd minus_end = MinusEnd::free;  // free | hinged | clamped
  bool growing = false;                 // follows [dynamic_instability]
  bool nonlocal = false;                // feels the flow of its own forces beyond local drag (own_flow.hpp)
};

struct FiberSpec {
  FiberMaterialSpec material;
  std::vector<Vec3d> points;  // um, from minus to plus end, at least 2: a smooth curve through them; or
  Vec3d position;             // um, of the minus end, with
  Vec3d direction{1, 0, 0};   // from minus to plus end, any length but zero, and
  double length = 5.0;        // um, > 0: a straight fiber
  std::string body;           // name of the body that holds the minus end; empty: space does
  Vec3d end_force;            // pN, on the plus end
  Vec3d force_density;        // pN/um, along the whole fiber
};

struct AsterSpec {
  enum class Arrangement { random, even };
  enum class Lengths { equal, uniform, exponential, steady };

  FiberMaterialSpec material{.minus_end = MinusEnd::clamped};  // a fiber of an aster is not free
  std::string body;     // name of the body that carries the centrosome; empty: it is fixed in space
  Vec3d position;       // um, of the centrosome, in the frame of the body
  Vec3d axis{1, 0, 0};  // of the aster, in the frame of the body; not given: from its centre to the centrosome
  double centrosome_radius = 0.5;  // um, >= 0: fibers start so far from `position`
  double opening = 90.0;           // degrees, 0 to 180: largest angle between a fiber and the axis; 180: all directions
  int count = 100;                 // fibers, >= 0
  Arrangement arrangement = Arrangement::random;  // random: independent, uniform over the opening; even: on a spiral
  Lengths lengths = Lengths::equal;               // equal; uniform from minimal_length to 2 length - minimal_length;
                                                  // exponential beyond minimal_length with that mean; steady: those
                                                  // to which dynamic instability leads in a cell at rest
  double length = 5.0;                            // um, > minimal_length: the mean
  double minimal_length = 0.5;                    // um, > 0
};

FiberSpec read_fiber(Table table);
PointArray points_along(FiberSpec const& fiber);  // um, from minus to plus end, to judge where the fiber lies
AsterSpec read_aster(Table table);

// Minus end and length of a fiber of an aster.
struct AsterFiber {
  MinusEndSite site;
  double length;  // um
};

// The first `count` fibers of an aster, a pure function of (seed, number of the aster): more fibers do not move the
// first ones when the arrangement is random. `body`: index of its body or -1. `reach`, if not empty, gives how long a
// fiber on that site may be, um. `decay`: 1/um, of steady lengths.
std::vector<AsterFiber> aster_fibers(AsterSpec const& aster, int count, int body, std::uint64_t seed,
                                     std::uint64_t number,
                                     std::function<double(MinusEndSite const&)> const& reach = {},
                                     double decay = 0.0);

}  // namespace asterflow
