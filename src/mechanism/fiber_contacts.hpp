#pragma once
// What steric repulsion does to one fiber in a step: at its hydrodynamic nodes and, as one um of it, at a plus end that nothing
// else holds. What is in contact, and the wall there, is found by repeating the fiber's local answer until it rests. The force
// is then linear in the step where the cortex or the fiber's own body exerts it; other bodies exert the force of that local
// answer, and feel the opposite.

#include "base/rigid.hpp"
#include "fiber/fibers.hpp"
#include "mechanism/steric_repulsion_spec.hpp"
#include "surface/shapes.hpp"

#include <memory>
#include <span>
#include <vector>

namespace asterflow {

// What can touch a fiber.
struct FiberSurroundings {
  StericRepulsionSpec const& spec;
  Shape const* cortex;  // may be null
  std::span<std::shared_ptr<Shape const> const> bodies;
  std::span<BodyMotionMap const> maps;
  std::span<Vector6 const> motions;  // of the bodies, as expected
};

// What a body feels of a fiber that it does not hold, and how much of it its motion q takes back if the fiber does not yield:
// load - resistance (q - expected). Of the body that holds the fiber only the second; the first comes through the fiber.
struct BodyReaction {
  std::size_t body;
  Vector6 load;        // pN, pN um about its centre
  Matrix6 resistance;  // pN s/um, pN s, pN s um
};

class FiberContacts {
 public:
  FiberContacts(FiberSurroundings const& around, Fibers& fibers, std::size_t fiber);

  // Plans the loads of the fiber, after prepare, and takes back those planned before; u [n_node of all fibers]: incident flow,
  // extrapolated; `free_tip`: the load of the plus end without contacts.
  std::vector<BodyReaction> hold(ConstPoints u, TipLoad const& free_tip);

 private:
  struct Wall {
    int body;         // -1: the cortex
    double distance;  // um, from the fiber
    Vec3d away;       // unit vector along which the distance grows
  };
  struct Push {  // force - stiffness dX
    Vec3d force;        // pN/um at a node, pN at the plus end
    Matrix3 stiffness;  // the same per um
  };
  struct Touch : Push {
    std::size_t body, node;  // at the plus end: no node
  };

  bool is_own(Wall const& wall) const { return holder_ >= 0 && wall.body == holder_; }
  template <class Function>
  void for_walls(Vec3d position, double arc_length, Function&& function) const;
  bool find_wall(int body, Vec3d position, Wall& wall) const;
  Push push(double strength, Wall const& wall) const;
  void let_go(TipLoad const& free_tip);
  void answer(ConstPoints u);
  bool find_loads(TipLoad const& free_tip);
  std::vector<BodyReaction> settle();

  FiberSurroundings const& around_;
  Fibers& fibers_;
  std::size_t fiber_, first_;  // its first node
  int holder_;                 // body that holds it, -1: none
  Vector6 motion_;             // of that body
  PointArray predicted_;       // [n_node] um
  PointArray positions_;       // [n_node] um, local answer
  Vec3d plus_end_;             // um, the same
  std::vector<Touch> plus_end_touches_, node_touches_;  // with bodies that do not hold the fiber
};

}  // namespace asterflow
