#pragma once
// Fibers frozen in their present shape, for the instantaneous resistance of a scene: local slender-body drag
//   f = (1/c) (I - t t / 2) (v - u)      [physics: straight fiber, F_perp = U L / c, F_par = U L / (2 c)]
// with v the rigid motion of the body that holds the fiber, zero for a fiber held in space, and for a free fiber the
// rigid motion that leaves it without force and torque.

#include "fiber/fibers.hpp"
#include "system/scattering.hpp"

#include <optional>

namespace asterflow {

class RigidFibers final : public FiberAnswers {
 public:
  RigidFibers(Fibers const& fibers, double viscosity, std::vector<RigidPose> const& poses);

  FiberNodes nodes() const override { return {nodes_, weights_, &first_}; }
  void add_linear_response(ConstPoints u, std::span<Vector6 const> motions, Points f,
                           std::span<Vector6> loads) const override;
  void add_loads(ConstPoints u, std::span<Vector6> loads) const override;
  void add_own_flow(ConstPoints force_density, Points u) const override;
  void add_affine_response(Points, std::span<Vector6>) const override {}
  void add_body_resistance(std::span<Matrix6> resistances) const override;

 private:
  enum class Hold { body, space, none };
  struct Fiber {
    Hold hold;
    int body;
    Vec3d origin;          // of its rigid motions: the body's centre or the fiber's middle, um
    double mobility;       // c, um^2 / (pN s)
    Matrix6 resistance;    // of the fiber alone about the origin
    std::optional<OwnFlow> own_flow;
  };

  Vec3d drag(Fiber const& fiber, std::size_t node, Vec3d velocity) const;
  Vector6 load(Fiber const& fiber, std::size_t node, Vec3d force) const;

  std::vector<Fiber> fibers_;
  std::vector<std::size_t> first_{0};
  PointArray nodes_, tangents_;
  std::vector<double> weights_;
};

}  // namespace asterflow
