#include "surface/dirichlet_flow.hpp"

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/timer.hpp"
#include "surface/axisymmetric_dirichlet.hpp"
#include "surface/general_dirichlet.hpp"
#include "surface/operator_cache.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace asterflow {
namespace {

constexpr double worth_storing = 0.3;  // s, to make an operator

// Shells needed along the radius. A field of degree p in rho (or s) has Chebyshev coefficients that fall like
// exp(-k^2 / p); outside a slender shape the field is singular at s = 1 / eccentricity, inside the shape.
int shell_count(Shape const& shape, Side side, int n_ring, double accuracy) {
  double const digits = std::log(10.0 / accuracy);
  double const smooth = std::min(n_ring + 2.0, std::sqrt((n_ring + 1.0) * digits) * 1.1 + 3.0);
  double const aspect = shape.aspect_ratio();
  if (side == Side::interior || aspect < 1.01) return static_cast<int>(smooth);
  double const singularity = 2.0 / std::sqrt(1.0 - 1.0 / (aspect * aspect)) - 1.0;  // on the axis where [-1, 1] is s
  double const rate = std::log(singularity + std::sqrt(singularity * singularity - 1.0));
  return static_cast<int>(std::min(80.0, std::max(smooth, digits / rate + 3.0)));
}

// Half the length of a shape along its polar axis over its largest radius across, at least 1.
double elongation(Shape const& shape) {
  auto const distance = [&](double theta, double phi) { return norm(shape.point(theta, phi) - shape.centre()); };
  constexpr double pi = std::numbers::pi, quarter = 0.5 * pi;
  double const along = std::max(distance(0.0, 0.0), distance(pi, 0.0));
  return std::max(1.0, along / std::max(distance(quarter, 0.0), distance(quarter, quarter)));
}

// Orders that a flat shape needs over those of a sphere (a long one has more rings instead), and those that gain no digit yet.
constexpr double orders_per_digit = 4.0;
double slenderness(Shape const& shape) {
  return 0.6 + 0.4 * std::sqrt(std::clamp(shape.aspect_ratio() / elongation(shape), 1.0, 9.0));
}
double first_order(Shape const& shape) { return slenderness(shape) + (shape.axisymmetric() ? 0.0 : 3.0); }

// Rings of a grid over those of the square one.
double ring_stretch(Shape const& shape) {
  double const length = elongation(shape);
  return std::min(length, 1.2 * std::sqrt(length));
}

// Place of the shell of that scale over pi: scale = (1 + cos psi) / 2.
double psi_of(double scale) { return 2.0 / std::numbers::pi * std::atan2(std::sqrt(1.0 - scale), std::sqrt(scale)); }

}  // namespace

DirichletFlow::DirichletFlow(Surface surface, Side side, double accuracy)
    : surface_(std::make_unique<Surface const>(std::move(surface))), side_(side),
      n_shell_(shell_count(surface_->shape(), side, surface_->grid().n_ring(), accuracy)),
      table_(surface_->grid(), n_shell_, InterpolationWindow::width_for(accuracy), 2.0),
      rough_table_(surface_->grid(), n_shell_, InterpolationWindow::widths[0], 1.25) {
  ASTERFLOW_REQUIRE(surface_->grading().uniform());
  OperatorKey const key(*surface_, side, n_shell_, accuracy);
  auto stored = read_operator(key);
  bool const is_new = stored.empty();
  Timer const timer;
  if (surface_->axisymmetric())
    operator_ = std::make_unique<AxisymmetricDirichlet>(*surface_, side, n_shell_, accuracy, std::move(stored));
  else
    operator_ = std::make_unique<GeneralDirichlet>(*surface_, side, n_shell_, accuracy, std::move(stored));
  if (is_new && timer.seconds() > worth_storing) write_operator(key, operator_->matrices());
}

DirichletFlow::Targets DirichletFlow::plan(ConstPoints targets) const {
  Targets result;
  plan(targets, result);
  return result;
}

void DirichletFlow::plan(ConstPoints targets, Targets& result) const {
  result.points_.resize(targets.size());
  constexpr long chunk = 256;
  auto const n = static_cast<long>(targets.size());
  parallel_for("DirichletFlow::plan", (n + chunk - 1) / chunk, [&](long block) {
    for (long i = block * chunk; i < std::min(n, (block + 1) * chunk); ++i) {
      ShellPoint const at = surface_->shape().shell_point(targets[i]);
      double const outside = side_ == Side::interior ? at.rho - 1.0 : 1.0 - at.rho;
      if (!(outside <= 1e-3))
        throw NumericalError(fmt::format("target {} at ({}, {}, {}) um lies on the wrong side of a surface, scale {}", i,
                                         targets[i].x, targets[i].y, targets[i].z, at.rho));
      double const scale = std::min(1.0, side_ == Side::interior ? at.rho : 1.0 / at.rho);
      result.points_[i] = {ShellTable::locate(psi_of(scale), surface_->to_polar(at.direction)), side_ == Side::interior ? 1.0 : scale};
    }
  });
  result.set_range();
}

void DirichletFlow::Targets::set_range() {
  range_ = {};
  for (Point const& point : points_) range_.add(point.table.psi);
}

void DirichletFlow::Targets::within(double scale, Targets& inside, std::vector<std::size_t>& places) const {
  inside.points_.clear();
  places.clear();
  double const last = psi_of(std::min(scale, 1.0));
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (points_[i].table.psi < last) continue;
    double const c = std::cos(0.5 * std::numbers::pi * points_[i].table.psi);
    inside.points_.push_back(points_[i]);
    inside.points_.back().table.psi = psi_of(std::min(1.0, c * c / scale));
    places.push_back(i);
  }
  inside.set_range();
}

void DirichletFlow::add_velocity(ConstPoints boundary_velocity, Targets const& targets, Points velocity) const {
  add_interpolated(table_, work_, boundary_velocity, targets, velocity);
}

void DirichletFlow::add_rough_velocity(ConstPoints boundary_velocity, Targets const& targets, Points velocity) const {
  add_interpolated(rough_table_, rough_work_, boundary_velocity, targets, velocity);
}

template <class Real>
void DirichletFlow::add_interpolated(ShellTable const& table, Evaluation<Real>& work, ConstPoints boundary_velocity,
                                     Targets const& targets, Points velocity) const {
  ASTERFLOW_REQUIRE(targets.size() == velocity.size());
  operator_->shell_modes(boundary_velocity, work.modes);
  table.fill(work.modes, targets.range_, work.values);
  constexpr long chunk = 256;
  auto const n = static_cast<long>(targets.size());
  parallel_for("DirichletFlow::interpolate", (n + chunk - 1) / chunk, [&](long block) {
    for (long i = block * chunk; i < std::min(n, (block + 1) * chunk); ++i) {
      Targets::Point const& point = targets.points_[i];
      double u[3];
      table.interpolate(work.values, point.table, u);
      velocity[i] += point.factor * surface_->from_polar({u[0], u[1], u[2]});
    }
  });
}

Vector6 DirichletFlow::load(ConstPoints boundary_velocity) const {
  Vector6 const polar = operator_->load(boundary_velocity);
  Vec3d const force = surface_->from_polar({polar[0], polar[1], polar[2]});
  Vec3d const torque =
      surface_->from_polar({polar[3], polar[4], polar[5]}) + cross(surface_->shape().centre(), force);
  return {force.x, force.y, force.z, torque.x, torque.y, torque.z};
}

Matrix6 DirichletFlow::resistance() const {
  Matrix6 result;
  PointArray motion(surface_->size());
  for (int column = 0; column < 6; ++column) {
    Vec3d axis;
    axis[column % 3] = 1.0;
    for (std::size_t i = 0; i < motion.size(); ++i) motion[i] = column < 3 ? axis : cross(axis, surface_->nodes()[i]);
    result.col(column) = load(motion);
  }
  return result;
}

std::size_t DirichletFlow::memory() const {
  return table_.memory() + rough_work_.values.memory() + operator_->memory();
}

SphereGrid grid_of_order(Shape const& shape, int order) {
  return {order, static_cast<int>(std::lround((order + 1) * ring_stretch(shape)))};
}

int default_order(Shape const& shape, double accuracy) {
  double const digits = std::clamp(-std::log10(accuracy), 2.0, 12.0);
  int const highest = shape.axisymmetric() ? 64 : static_cast<int>(33.0 / std::sqrt(ring_stretch(shape))) - 1;  // 1 GB if triaxial
  return std::clamp(static_cast<int>(std::lround(digits * orders_per_digit * slenderness(shape) + first_order(shape))), 6,
                    highest);
}

double resolved_accuracy(Shape const& shape, int order) {
  return std::pow(10.0, -(order - first_order(shape)) / (orders_per_digit * slenderness(shape)));
}

}  // namespace asterflow
