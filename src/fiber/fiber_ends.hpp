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

// Force per length on one node of a fiber, pN/um: force - stiffness dX, implicit in the displacement dX of the node from its
// predicted position. Internal: the body that holds the fiber exerts it and feels the opposite; dX is relative to it.
struct NodeLoad {
  Vec3d force{};                        // pN/um
  Matrix3 stiffness = Matrix3::Zero();  // pN/um^2, symmetric, not negative
  bool is_internal = false;
};

// Where the load of a step moves a plus end, and how a further force on it would.
struct TipAnswer {
  Vec3d position{};                      // um
  Matrix3 compliance = Matrix3::Zero();  // um/pN, symmetric, not negative
};

// Force per length along the fiber, pN/um. The fluid feels the external part, but not the motors' part, which the
// motors' cargo gives back to it (cytoplasmic pulling).
struct FiberLoad {
  Vec3d external{};    // the same along the whole fiber
  double motor = 0.0;  // along the tangent, towards the plus end
};

// What a plus end does. The numbers are those of stored states.
enum class TipState : int {
  still = 0,      // neither grows nor shrinks
  growing = 1,    // away from the cortex
  shrinking = 2,
  pushing = 3,    // grows against the cortex
  captured = 4,   // held and pulled by a cortical site
};

// What the ends of a fiber feel and pass on, and what others exert on its nodes.
struct EndForces {
  Vec3d plus_end{};          // pN, on the plus end
  Vec3d minus_end{};         // pN, of the fiber on what holds its minus end: F(0) = T X_s - E X_sss
  Vec3d minus_end_torque{};  // pN um, about the minus end
  Vec3d contact{};           // pN, sum of the loads on its nodes, but for those of the body that holds it
  Vec3d contact_torque{};    // pN um, of the same about the minus end
};

}  // namespace asterflow
