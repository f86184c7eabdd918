#include "system/rigid_fibers.hpp"

#include "base/parallel.hpp"

#include <Eigen/Eigenvalues>

namespace asterflow {
namespace {

// Least-squares solution: a straight thin fiber does not resist a turn about itself.
Vector6 free_motion(Matrix6 const& resistance, Vector6 const& load) {
  Eigen::SelfAdjointEigenSolver<Matrix6> const eigen(resistance);
  Vector6 inverse = eigen.eigenvalues();
  double const smallest = 1e-10 * inverse.maxCoeff();
  for (double& value : inverse) value = value > smallest ? 1 / value : 0.0;
  return eigen.eigenvectors() * (inverse.asDiagonal() * (eigen.eigenvectors().transpose() * load));
}

}  // namespace

RigidFibers::RigidFibers(Fibers const& fibers, double viscosity, std::vector<RigidPose> const& poses) {
  for (std::size_t i = 0; i < fibers.count(); ++i) {
    auto const& shape = fibers.shape(i);
    auto const& site = fibers.site(i);
    auto const& properties = fibers.properties(i);
    FiberBasis const& basis = fiber_basis(properties.n_node);
    std::vector<double> s;
    for (double const alpha : basis.gauss.nodes) s.push_back(alpha * shape.length);
    std::size_t const n = nodes_.size();
    nodes_.resize(n + s.size());
    tangents_.resize(n + s.size());
    sample(shape, s, Points(nodes_).subspan(n), Points(tangents_).subspan(n));
    for (double const weight : basis.gauss.weights) weights_.push_back(weight * shape.length);
    first_.push_back(nodes_.size());

    Fiber fiber{};
    fiber.hold = site.is_attached() ? Hold::body : site.kind == MinusEnd::free ? Hold::none : Hold::space;
    fiber.body = site.body;
    fiber.origin = fiber.hold == Hold::body ? poses[site.body].position : nodes_[n + s.size() / 2];
    fiber.mobility = slender_body_mobility(shape.length, properties.radius, viscosity);
    fiber.resistance.setZero();
    for (int k = 0; k < 6; ++k)
      for (std::size_t j = n; j < nodes_.size(); ++j)
        fiber.resistance.col(k) +=
            load(fiber, j, drag(fiber, j, velocity_of_motion(Vector6::Unit(k), nodes_[j] - fiber.origin)));
    if (properties.is_nonlocal)
      fiber.own_flow.emplace().prepare(basis, shape, ConstPoints(nodes_).subspan(n), fiber.mobility, viscosity);
    fibers_.push_back(std::move(fiber));
  }
}

Vec3d RigidFibers::drag(Fiber const& fiber, std::size_t node, Vec3d velocity) const {
  Vec3d const t = tangents_[node];
  return (velocity - (0.5 * dot(t, velocity)) * t) / fiber.mobility;
}

Vector6 RigidFibers::load(Fiber const& fiber, std::size_t node, Vec3d force) const {
  Vec3d const weighted = weights_[node] * force;
  return load_of_force(weighted, nodes_[node] - fiber.origin);
}

void RigidFibers::add_linear_response(ConstPoints u, std::span<Vector6 const> motions, Points f,
                                      std::span<Vector6> loads) const {
  for (std::size_t i = 0; i < fibers_.size(); ++i) {
    auto const& fiber = fibers_[i];
    Vector6 motion = Vector6::Zero(), received = Vector6::Zero();
    if (fiber.hold == Hold::body) motion = motions[fiber.body];
    if (fiber.hold == Hold::none) {
      for (std::size_t j = first_[i]; j < first_[i + 1]; ++j) received += load(fiber, j, drag(fiber, j, u[j]));
      motion = free_motion(fiber.resistance, received);
      received.setZero();
    }
    for (std::size_t j = first_[i]; j < first_[i + 1]; ++j) {
      Vec3d const force = drag(fiber, j, velocity_of_motion(motion, nodes_[j] - fiber.origin) - u[j]);
      f[j] += force;
      received -= load(fiber, j, force);
    }
    if (fiber.hold == Hold::body && !loads.empty()) loads[fiber.body] += received;
  }
}

void RigidFibers::add_loads(ConstPoints u, std::span<Vector6> loads) const {
  for (std::size_t i = 0; i < fibers_.size(); ++i)
    if (auto const& fiber = fibers_[i]; fiber.hold == Hold::body)
      for (std::size_t j = first_[i]; j < first_[i + 1]; ++j)
        loads[fiber.body] += load(fiber, j, drag(fiber, j, u[j]));
}

void RigidFibers::add_own_flow(ConstPoints force_density, Points u) const {
  for (std::size_t i = 0; i < fibers_.size(); ++i) {
    std::size_t const first = first_[i], n = first_[i + 1] - first;
    if (fibers_[i].own_flow) fibers_[i].own_flow->add(force_density.subspan(first, n), u.subspan(first, n));
  }
}

void RigidFibers::add_body_resistance(std::span<Matrix6> resistances) const {
  for (auto const& fiber : fibers_)
    if (fiber.hold == Hold::body) resistances[fiber.body] += fiber.resistance;
}

}  // namespace asterflow
