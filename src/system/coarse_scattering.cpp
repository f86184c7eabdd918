#include "system/coarse_scattering.hpp"

#include "base/timer.hpp"
#include "surface/grid_transfer.hpp"

#include <algorithm>
#include <map>
#include <mutex>

namespace asterflow {
namespace {

using RowMajor3 = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

// Transfers between grids of two orders depend on nothing else: made once, kept for ever.
Eigen::MatrixXd const& transfer(SphereGrid const& from, SphereGrid const& to) {
  static std::map<std::pair<int, int>, Eigen::MatrixXd> made;
  static std::mutex guard;
  std::scoped_lock lock(guard);
  auto const [entry, is_new] = made.try_emplace({from.order(), to.order()});
  if (is_new) entry->second = grid_transfer(from, to);
  return entry->second;
}

}  // namespace

CoarseScattering::CoarseScattering(Scattering const& problem, FiberNodes const& fibers,
                                   std::vector<BodyDrive> const& bodies, Radiation const& fine, Radiation& coarse,
                                   ScatteringOptions const& options)
    : problem_(problem), coarse_(coarse), options_(options), fibers_(*fibers.first, options.coarsening),
      n_body_(bodies.size()), n_fiber_node_(fibers.positions.size()) {
  PointArray positions(fibers_.size());
  std::vector<double> weights(fibers_.size());
  fibers_.restrict_values(fibers.positions, positions);
  fibers_.coarse_weights(fibers.weights, weights);
  std::vector<RigidPose> poses;
  for (auto const& body : bodies) poses.push_back(body.pose);
  coarse_.set_geometry({positions, weights, &fibers_.coarse_first()}, poses);

  auto const add = [&](Surface const& from, Surface const& to, std::size_t first_fine, std::size_t first_coarse) {
    surfaces_.push_back({first_fine, first_coarse, &transfer(from.grid(), to.grid()), &transfer(to.grid(), from.grid())});
  };
  for (std::size_t b = 0; b < n_body_; ++b)
    add(fine.body_surface(b), coarse_.body_surface(b), fine.first_body_node(b), coarse_.first_body_node(b));
  if (fine.has_periphery())
    add(fine.periphery_surface(), coarse_.periphery_surface(), fine.first_periphery_node(),
        coarse_.first_periphery_node());
  fine_velocity_.resize(n_fiber_node_);
  fine_force_.resize(n_fiber_node_);
  coarse_force_.resize(fibers_.size());
}

void CoarseScattering::restrict_nodes(ConstPoints fine, Points coarse) const {
  fibers_.restrict_values(fine.first(n_fiber_node_), coarse.first(fibers_.size()));
  for (auto const& s : surfaces_) {
    Eigen::Map<RowMajor3 const> const from(&fine[s.first_fine].x, s.restriction->cols(), 3);
    Eigen::Map<RowMajor3>(&coarse[s.first_coarse].x, s.restriction->rows(), 3).noalias() = *s.restriction * from;
  }
}

void CoarseScattering::add_prolonged(ConstPoints coarse, Points fine) const {
  PointArray velocity(n_fiber_node_);
  fibers_.prolong_values(coarse.first(fibers_.size()), velocity);
  for (std::size_t i = 0; i < n_fiber_node_; ++i) fine[i] += velocity[i];
  for (auto const& s : surfaces_) {
    Eigen::Map<RowMajor3 const> const from(&coarse[s.first_coarse].x, s.prolongation->cols(), 3);
    Eigen::Map<RowMajor3>(&fine[s.first_fine].x, s.prolongation->rows(), 3).noalias() += *s.prolongation * from;
  }
}

// result = (I - L_c) z
void CoarseScattering::apply(ConstVector z, Vector result) {
  ConstPoints const incident = as_points(z);
  std::vector<Vector6> loads, motions;
  for (std::size_t b = 0; b < n_body_; ++b) loads.push_back(coarse_.load_of_incident(b, incident));
  fibers_.prolong_values(incident.first(fibers_.size()), fine_velocity_);
  problem_.answer(fine_velocity_, loads, false, fine_force_, motions);
  fibers_.restrict_values(fine_force_, coarse_force_);
  coarse_.exchange(coarse_force_, motions, incident, as_points(result));
  for (std::size_t i = 0; i < z.size(); ++i) result[i] = z[i] - result[i];
}

void CoarseScattering::precondition(ConstVector r, Vector result) {
  Timer const timer;
  std::size_t const n = coarse_.nodes().size();
  PointArray restricted(n), solution(n);
  restrict_nodes(as_points(r), restricted);
  auto const a = [this](ConstVector z, Vector y) { apply(z, y); };
  iterations_ += solve_gmres(a, {}, as_vector(restricted), as_vector(solution),
                             {.tolerance = options_.inner_tolerance, .max_iterations = options_.inner_max_iterations})
                     .iterations;
  for (std::size_t i = 0; i < n; ++i) solution[i] -= restricted[i];
  std::copy(r.begin(), r.end(), result.begin());
  add_prolonged(solution, as_points(result));
  seconds_ += timer.seconds();
}

}  // namespace asterflow
