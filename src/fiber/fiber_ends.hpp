#pragma once
// What holds a fiber's minus end (s = 0), what loads its plus end (s = L) and its length, and how a site on a rigid
// body moves with that body during an implicit step.

#include "base/rigid.hpp"

namespace asterflow {

enum class MinusEnd {
  free,     // no force, no torque
  hinged,   // position held, no torque
  clamped,  // position and tangent held
};

// Where the minus end is held: in the frame of a body, or in space when there is none. Ignored when it is free.
struct MinusEndSite {
  MinusEnd kind = MinusEnd::free;
  int body = -1;             // index of the body, -1: fixed in space
  Vec3d position{};          // um
  Vec3d direction{1, 0, 0};  // unit tangent at s = 0, used when clamped and for newborn fibers
  bool is_attached() const { return kind != MinusEnd::free && body >= 0; }
};

// Force on the plus end, pN: force - stiffness (X(L) - anchor), implicit in the new position of the tip.
struct TipLoad {
  Vec3d force{};                        // pN
  Matrix3 stiffness = Matrix3::Zero();  // pN/um, symmetric, not negative
  Vec3d anchor{};                       // um
};

// Force per length along the fiber, pN/um. The fluid feels the external part, but not the motors' part, which the
// motors' cargo gives back to it (cytoplasmic pulling).
struct FiberLoad {
  Vec3d external{};    // the same along the whole fiber
  double motor = 0.0;  // along the tangent, towards the plus end
};

}  // namespace asterflow
