#include "surface/resistance.hpp"

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "linalg/gmres.hpp"
#include "surface/double_layer.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <memory>

namespace asterflow {
namespace {

using Eigen::MatrixXd;
constexpr int highest_order = 56;

// Where a surface comes close to another one.
struct CloseSpot {
  double width;     // radians, of the gap's flow on the parameter sphere
  Vec3d direction;  // on the parameter sphere
};

// The flow in a gap g between surfaces of radii a and b varies over (2 g r)^(1/2), r the smaller radius.
CloseSpot close_spot(PlacedSurface const& surface, Vec3d point, double gap, double radius) {
  ClosestPoint const at = surface.shape->closest_point(surface.to_shape(point));
  Eigen::Vector3d const d(at.direction.x, at.direction.y, at.direction.z);
  double const stretch = (surface.shape->image(at.direction).jacobian * d.unitOrthogonal()).norm();
  return {std::sqrt(2.0 * gap * radius) / stretch, at.direction};
}

// [surface] spots that need crowded nodes, the narrowest first.
using CloseSpots = std::vector<std::vector<CloseSpot>>;

CloseSpots find_close_spots(std::vector<PlacedSurface> const& surfaces) {
  CloseSpots spots(surfaces.size());
  for (std::size_t i = 0; i < surfaces.size(); ++i)
    for (std::size_t j = i + 1; j < surfaces.size(); ++j) {
      Contact const contact = find_contact(surfaces[i], surfaces[j]);
      double const radius = std::min(surfaces[i].shape->size(), surfaces[j].shape->size());
      if (!(contact.gap > 0.0)) throw SceneError(fmt::format("surfaces {} and {} overlap by {} um", i, j, -contact.gap));
      if (contact.gap < 1e-4 * radius)
        throw NumericalError(fmt::format("the gap of {} um between surfaces {} and {} is below 1e-4 of their size, {} um", contact.gap, i, j, radius));
      spots[i].push_back(close_spot(surfaces[i], contact.first, contact.gap, radius));
      spots[j].push_back(close_spot(surfaces[j], contact.second, contact.gap, radius));
    }
  for (auto& of_surface : spots) {
    std::erase_if(of_surface, [](CloseSpot const& spot) { return spot.width >= 1.0; });
    std::ranges::sort(of_surface, {}, &CloseSpot::width);
  }
  return spots;
}

Surface place_nodes(PlacedSurface const& surface, std::vector<CloseSpot> const& spots, int order) {
  if (spots.empty()) return Surface(surface.shape, order);
  // Where the contact is at a pole of an axisymmetric shape, stay on its axis exactly.
  int const axis = surface.shape->polar_axis();
  Vec3d pole = normalized(spots.front().direction);
  if (surface.shape->axisymmetric() && std::abs(pole[axis]) > 1.0 - 1e-9) {
    double const sign = pole[axis] > 0.0 ? 1.0 : -1.0;
    pole = {};
    pole[axis] = sign;
  }
  return Surface(surface.shape, order, Grading(pole_frame(pole), spots.front().width));
}

// All surfaces' densities, one after the other, each in its own frame.
class BoundarySystem {
 public:
  BoundarySystem(std::vector<PlacedSurface> surfaces, CloseSpots const& spots, int order, double accuracy)
      : surfaces_(std::move(surfaces)) {
    double const digits = std::clamp(4.0 - std::log10(accuracy), 6.0, 13.0);
    for (std::size_t i = 0; i < surfaces_.size(); ++i) {
      layers_.push_back(std::make_unique<DoubleLayer>(place_nodes(surfaces_[i], spots[i], order),
                                                      surfaces_[i].encloses ? Side::interior : Side::exterior, digits));
      first_.push_back(size_);
      size_ += layers_.back()->surface().size();
    }
    couplings_.resize(surfaces_.size() * surfaces_.size());
    for (std::size_t i = 0; i < surfaces_.size(); ++i)
      for (std::size_t j = 0; j < surfaces_.size(); ++j)
        if (i != j) assemble_coupling(i, j);
  }

  std::size_t size() const { return size_; }  // nodes
  DoubleLayer const& layer(std::size_t i) const { return *layers_[i]; }

  template <class Array>
  auto block(Array values, std::size_t i) const {
    return values.subspan(first_[i], layers_[i]->surface().size());
  }

  void apply(ConstPoints q, Points v) const {
    for (std::size_t i = 0; i < layers_.size(); ++i) {
      layers_[i]->apply(block(q, i), block(v, i));
      for (std::size_t j = 0; j < layers_.size(); ++j)
        if (i != j) add_coupling(i, j, block(q, j), block(v, i));
    }
  }

  void precondition(ConstPoints v, Points q) const {
    for (std::size_t i = 0; i < layers_.size(); ++i) layers_[i]->precondition(block(v, i), block(q, i));
  }

 private:
  // Velocity of surface j at the nodes of surface i, both in their own frames.
  void assemble_coupling(std::size_t i, std::size_t j) {
    MatrixXd& a = couplings_[i * layers_.size() + j];
    Surface const& target = layers_[i]->surface();
    Eigen::Matrix3d const turn = (surfaces_[i].orientation.conjugate() * surfaces_[j].orientation).toRotationMatrix();
    a.resize(3 * layers_[j]->surface().size(), 3 * target.size());  // transposed: a target is contiguous
    parallel_for("BoundarySystem::couplings", static_cast<long>(target.size()), [&](long k) {
      Vec3d const x = surfaces_[j].to_shape(surfaces_[i].to_laboratory(target.nodes()[k]));
      a.middleCols<3>(3 * k) = (turn * layers_[j]->rows(x)).transpose();
    });
  }

  void add_coupling(std::size_t i, std::size_t j, ConstPoints q, Points v) const {
    MatrixXd const& a = couplings_[i * layers_.size() + j];
    constexpr long chunk = 32;
    auto const n = static_cast<long>(v.size());
    parallel_for("BoundarySystem::add_coupling", (n + chunk - 1) / chunk, [&](long block) {
      long const first = 3 * block * chunk, count = std::min<long>(3 * n - first, 3 * chunk);
      flat(v).segment(first, count).noalias() += a.middleCols(first, count).transpose() * flat(q);
    });
    if (surfaces_[j].encloses) return;
    DoubleLayer::Load const load = layers_[j]->load(q);
    for (std::size_t k = 0; k < v.size(); ++k) {
      Vec3d const x = surfaces_[j].to_shape(surfaces_[i].to_laboratory(layers_[i]->surface().nodes()[k]));
      v[k] += surfaces_[i].turn_to_shape(surfaces_[j].turn_to_laboratory(layers_[j]->velocity_of_load(load, x)));
    }
  }

  std::vector<PlacedSurface> surfaces_;
  std::vector<std::unique_ptr<DoubleLayer>> layers_;
  std::vector<std::size_t> first_;
  std::vector<MatrixXd> couplings_;
  std::size_t size_ = 0;
};

// Measured on spheres and ellipsoids: a crowded pole converges like exp(-3.2 p / K), K ~ log(8 / width); a second close
// spot, away from the pole, like the multipole series.
int choose_order(std::vector<PlacedSurface> const& surfaces, CloseSpots const& spots, double accuracy) {
  double const digits = std::log(1.0 / accuracy);
  double order = 6.0;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    order = std::max(order, (4.0 + digits) * (0.6 + 0.4 * std::sqrt(surfaces[i].shape->aspect_ratio())));
    if (spots[i].empty()) continue;
    double const period = std::log(8.0 / spots[i][0].width);
    order = std::max(order, 2.0 + digits * period / 3.2);
    if (spots[i].size() > 1) order = std::max(order, 0.5 * digits * period / spots[i][1].width);
  }
  if (order > highest_order)
    throw NumericalError(fmt::format("close surfaces need order {:.0f}, the highest is {}: ask for less accuracy or set the order",
                                     order, highest_order));
  return static_cast<int>(std::ceil(order));
}

ConstPoints const_points(ConstVector v) { return {reinterpret_cast<Vec3d const*>(v.data()), v.size() / 3}; }
Points points(Vector v) { return {reinterpret_cast<Vec3d*>(v.data()), v.size() / 3}; }

// Boundary velocity of a unit motion of one body: translation or rotation about its position along laboratory axis c.
void unit_motion(PlacedSurface const& body, Surface const& surface, int c, Points velocity) {
  Vec3d axis;
  axis[c % 3] = 1.0;
  axis = body.turn_to_shape(axis);
  for (std::size_t k = 0; k < velocity.size(); ++k)
    velocity[k] = c < 3 ? axis : cross(axis, surface.nodes()[k]);
}

Eigen::Matrix<double, 6, 1> body_load(PlacedSurface const& body, DoubleLayer const& layer, ConstPoints q) {
  DoubleLayer::Load const load = layer.load(q);
  Vec3d const force = body.turn_to_laboratory(load[0]);
  Vec3d const torque = body.turn_to_laboratory(load[1] + cross(layer.surface().shape().centre(), load[0]));
  Eigen::Matrix<double, 6, 1> result;
  result << force.x, force.y, force.z, torque.x, torque.y, torque.z;
  return result;
}

}  // namespace

Resistance solve_resistance(std::vector<PlacedSurface> const& bodies, std::optional<PlacedSurface> const& periphery,
                            ResistanceOptions const& options) {
  std::vector<PlacedSurface> surfaces = bodies;
  if (periphery) {
    surfaces.push_back(*periphery);
    surfaces.back().encloses = true;
  }
  CloseSpots const spots = find_close_spots(surfaces);
  Resistance result;
  result.order = options.order > 0 ? options.order : choose_order(surfaces, spots, options.accuracy);
  BoundarySystem const system(surfaces, spots, result.order, options.accuracy);

  auto const n = static_cast<Eigen::Index>(6 * bodies.size());
  result.resistance.resize(n, n);
  PointArray right(system.size()), density(system.size());
  Vector const density_numbers(&density.front().x, 3 * density.size());
  for (Eigen::Index column = 0; column < n; ++column) {
    auto const body = static_cast<std::size_t>(column / 6);
    std::ranges::fill(right, Vec3d{});
    std::ranges::fill(density, Vec3d{});
    unit_motion(bodies[body], system.layer(body).surface(), static_cast<int>(column % 6), system.block(Points(right), body));
    GmresResult const solve = solve_gmres(
        [&](ConstVector q, Vector v) { system.apply(const_points(q), points(v)); },
        [&](ConstVector v, Vector q) { system.precondition(const_points(v), points(q)); },
        {&right.front().x, 3 * right.size()}, density_numbers,
        {.tolerance = 0.03 * options.accuracy, .reference = 0.0, .max_iterations = 400, .restart = 200});
    if (!solve.converged)
      throw NumericalError(fmt::format("resistance problem: residual {} after {} iterations", solve.residual, solve.iterations));
    result.iterations = std::max(result.iterations, solve.iterations);
    for (std::size_t i = 0; i < bodies.size(); ++i)
      result.resistance.block<6, 1>(static_cast<Eigen::Index>(6 * i), column) =
          options.viscosity * body_load(bodies[i], system.layer(i), system.block(ConstPoints(density), i));
  }
  result.asymmetry = (result.resistance - result.resistance.transpose()).norm() / result.resistance.norm();
  if (!(result.asymmetry < 1e-2))
    throw NumericalError(fmt::format("resistance problem is not resolved by order {}: asymmetry {}", result.order, result.asymmetry));
  result.resistance = (0.5 * (result.resistance + result.resistance.transpose())).eval();
  result.mobility = result.resistance.inverse();
  return result;
}

}  // namespace asterflow
