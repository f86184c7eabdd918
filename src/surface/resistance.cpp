#include "surface/resistance.hpp"

#include "base/error.hpp"
#include "linalg/gmres.hpp"
#include "surface/boundary_system.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace asterflow {
namespace {

using Eigen::MatrixXd;
constexpr int highest_order_alone = 192;  // of one axisymmetric body: 1 GB
constexpr int most_refinements = 3;

// Of several surfaces: their couplings, 8 bytes x (6 (p + 1)^2)^2 for each ordered pair, take 3 GB.
int highest_order(std::size_t n_surface) {
  double const pairs = static_cast<double>(std::max<std::size_t>(2, n_surface * (n_surface - 1)));
  return static_cast<int>(48.0 * std::pow(2.0 / pairs, 0.25));
}

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

// Loads of all bodies for every unit motion, with solve(right, density).
template <class Solve>
MatrixXd loads_of_motions(std::vector<PlacedSurface> const& bodies, BoundarySystem const& system, Solve const& solve) {
  auto const n = static_cast<Eigen::Index>(6 * bodies.size());
  MatrixXd loads(n, n);
  PointArray right(system.size()), density(system.size());
  for (Eigen::Index column = 0; column < n; ++column) {
    auto const body = static_cast<std::size_t>(column / 6);
    std::ranges::fill(right, Vec3d{});
    std::ranges::fill(density, Vec3d{});
    unit_motion(bodies[body], system.layer(body).surface(), static_cast<int>(column % 6), system.block(Points(right), body));
    solve(ConstPoints(right), Points(density));
    for (std::size_t i = 0; i < bodies.size(); ++i)
      loads.block<6, 1>(static_cast<Eigen::Index>(6 * i), column) =
          body_load(bodies[i], system.layer(i), system.block(ConstPoints(density), i));
  }
  return loads;
}

MatrixXd solve_fine(std::vector<PlacedSurface> const& bodies, BoundarySystem const& system, CoarseCorrection const& correction,
                    double accuracy, int& iterations) {
  return loads_of_motions(bodies, system, [&](ConstPoints right, Points density) {
    GmresResult const solve = solve_gmres(
        [&](ConstVector q, Vector v) { system.apply(as_points(q), as_points(v)); },
        [&](ConstVector v, Vector q) { correction.precondition(as_points(v), as_points(q)); }, as_vector(right),
        as_vector(density), {.tolerance = 0.03 * accuracy, .reference = 0.0, .max_iterations = 400, .restart = 200});
    if (!solve.converged)
      throw NumericalError(fmt::format("resistance problem: residual {} after {} iterations", solve.residual, solve.iterations));
    iterations = std::max(iterations, solve.iterations);
  });
}

// Translations and rotations have different units: compare after scaling torques by the bodies' sizes.
double difference(std::vector<PlacedSurface> const& bodies, MatrixXd const& a, MatrixXd const& b) {
  Eigen::VectorXd scale(a.rows());
  for (std::size_t i = 0; i < bodies.size(); ++i)
    for (int c = 0; c < 6; ++c) scale[static_cast<Eigen::Index>(6 * i) + c] = c < 3 ? 1.0 : 1.0 / bodies[i].shape->size();
  MatrixXd const change = scale.asDiagonal() * (a - b) * scale.asDiagonal();
  return change.norm() / (scale.asDiagonal() * a * scale.asDiagonal()).norm();
}

int coarse_order(int order) { return std::max(6, order / 2); }

// Errors fall geometrically with the order, err(p) = C r^p; C is taken as 1/30 at most.
double error_of_fine(double change, int coarse, int fine) {
  return std::min(change, std::pow(30.0 * change, static_cast<double>(fine) / coarse) / 30.0);
}

int refined_order(double error, int order, double accuracy) {
  double const rate = std::log(std::clamp(30.0 * error, 1e-16, 0.3)) / order;
  return std::clamp(static_cast<int>(std::ceil(1.1 * std::log(30.0 * accuracy) / rate)), order + 4, 2 * order);
}

// Loads of all bodies, and those with a coarser order.
struct Loads {
  MatrixXd fine, rough;
  int iterations = 0, rough_order = 0;
};

// The loads at the first order, or at a higher one that meets the accuracy; loads_at(order) solves.
template <class LoadsAt>
Resistance refine(std::vector<PlacedSurface> const& bodies, ResistanceOptions const& options, int first_order,
                  int highest_order, LoadsAt const& loads_at) {
  bool const is_chosen = options.order > 0;
  Resistance result;
  result.order = is_chosen ? options.order : std::min(highest_order, first_order);
  MatrixXd before;  // loads with the order before
  for (int trial = 0, order_before = 0;; ++trial) {
    Loads const loads = loads_at(result.order);
    result.iterations = std::max(result.iterations, loads.iterations);
    double const asymmetry = difference(bodies, loads.fine, loads.fine.transpose());
    double error = error_of_fine(difference(bodies, loads.fine, loads.rough), loads.rough_order, result.order);
    if (trial > 0) error = std::min(error, error_of_fine(difference(bodies, loads.fine, before), order_before, result.order));
    result.error = std::max(asymmetry, error);
    before = loads.fine;
    order_before = result.order;
    result.resistance = options.viscosity * 0.5 * (loads.fine + loads.fine.transpose());
    if (is_chosen || result.error <= options.accuracy || result.order == highest_order || trial == most_refinements) break;
    result.order = std::min(highest_order, refined_order(result.error, result.order, options.accuracy));
  }
  if (!(result.error < 1e-2))
    throw NumericalError(fmt::format("resistance problem is not resolved by order {}: error {:.1e}", result.order, result.error));
  result.mobility = result.resistance.inverse();
  return result;
}

// The equation of one axisymmetric body alone is inverted mode by mode.
Loads loads_alone(std::vector<PlacedSurface> const& body, CloseSpots const& spots, int order, double accuracy) {
  auto const at = [&](int p) {
    BoundarySystem const system(body, spots, p, accuracy);
    return loads_of_motions(body, system,
                            [&](ConstPoints right, Points density) { system.precondition(right, density); });
  };
  return {at(order), at(coarse_order(order)), 0, coarse_order(order)};
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
  int const first_order = order_for(surfaces, spots, options.accuracy);
  if (surfaces.size() == 1 && surfaces.front().shape->axisymmetric())
    return refine(bodies, options, first_order, highest_order_alone,
                  [&](int order) { return loads_alone(bodies, spots, order, options.accuracy); });
  std::optional<BoundarySystem> coarse;  // of the first order
  return refine(bodies, options, first_order, highest_order(surfaces.size()), [&](int order) {
    if (!coarse) coarse.emplace(surfaces, spots, coarse_order(order), options.accuracy);
    BoundarySystem const fine(surfaces, spots, order, options.accuracy);
    CoarseCorrection const correction(fine, *coarse);
    Loads loads;
    loads.rough_order = coarse->order();
    loads.rough = loads_of_motions(
        bodies, *coarse, [&](ConstPoints right, Points density) { correction.solve_coarse(right, density); });
    loads.fine = solve_fine(bodies, fine, correction, options.accuracy, loads.iterations);
    return loads;
  });
}

}  // namespace asterflow
