#include "system/scattering.hpp"

#include "base/error.hpp"
#include "system/coarse_scattering.hpp"

#include <algorithm>

namespace asterflow {
Scattering::Scattering(FiberAnswers const& fibers, std::vector<BodyDrive> bodies, Radiation* radiation,
                       Radiation* coarse, ScatteringOptions options)
    : fibers_(fibers), bodies_(std::move(bodies)), radiation_(radiation), options_(options) {
  std::vector<Matrix6> resistances;
  std::vector<RigidPose> poses;
  for (auto const& body : bodies_) {
    resistances.push_back(body.resistance);
    poses.push_back(body.pose);
  }
  fibers_.add_body_resistance(resistances);
  for (auto const& resistance : resistances) held_resistance_.emplace_back(resistance);
  if (!radiation_) return;
  radiation_->set_geometry(fibers_.nodes(), poses);
  if (coarse && options_.coarsening > 0 && radiation_->n_fiber_nodes() > 0)
    coarse_ = std::make_unique<CoarseScattering>(*this, fibers_.nodes(), bodies_, *radiation_, *coarse, options_);
}

Scattering::~Scattering() = default;

ConstPoints Scattering::nodes() const { return radiation_ ? radiation_->nodes() : fibers_.nodes().positions; }

void Scattering::answer(ConstPoints u, std::vector<Vector6> loads, bool affine, Points force_density,
                        std::vector<Vector6>& motions) const {
  motions.assign(bodies_.size(), Vector6::Zero());
  std::fill(force_density.begin(), force_density.end(), Vec3d{});
  if (affine) fibers_.add_affine_response(force_density, loads);
  fibers_.add_linear_response(u, motions, force_density, loads);
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    auto const& body = bodies_[b];
    if (body.is_free)
      motions[b] = held_resistance_[b].solve(affine ? Vector6(loads[b] + body.value) : loads[b]);
    else if (affine)
      motions[b] = body.value;
  }
  if (!bodies_.empty()) {
    PointArray const still(u.size());
    fibers_.add_linear_response(still, motions, force_density, loads);
  }
}

void Scattering::apply(ConstVector z, Vector result, bool affine) const {
  ConstPoints const incident = as_points(z);
  std::vector<Vector6> loads, motions;
  for (std::size_t b = 0; b < bodies_.size(); ++b) loads.push_back(radiation_->load_of_incident(b, incident));
  PointArray force_density(radiation_->n_fiber_nodes());
  answer(incident.first(force_density.size()), loads, affine, force_density, motions);
  radiation_->exchange(force_density, motions, incident, as_points(result));
}

ScatteringSolution Scattering::solve(ConstPoints background, ConstPoints guess) {
  ScatteringSolution solution;
  std::size_t const n = nodes().size();
  solution.incident.assign(n, Vec3d{});
  if (radiation_) {
    PointArray b(n);
    apply(as_vector(solution.incident), as_vector(b), true);
    for (std::size_t i = 0; i < background.size(); ++i) b[i] += background[i];
    if (!guess.empty()) std::copy(guess.begin(), guess.end(), solution.incident.begin());
    auto const a = [&](ConstVector z, Vector result) {
      apply(z, result, false);
      for (std::size_t i = 0; i < z.size(); ++i) result[i] = z[i] - result[i];
    };
    LinearOperator preconditioner;
    if (coarse_) preconditioner = [&](ConstVector r, Vector result) { coarse_->precondition(r, result); };
    solution.gmres = solve_gmres(a, preconditioner, as_vector(b), as_vector(solution.incident),
                                 {.tolerance = options_.tolerance, .max_iterations = options_.max_iterations});
    if (coarse_) {
      solution.inner_iterations = coarse_->iterations();
      solution.coarse_seconds = coarse_->seconds();
    }
  } else {
    std::copy(background.begin(), background.end(), solution.incident.begin());
    solution.gmres.converged = true;
  }
  std::vector<Vector6> loads(bodies_.size(), Vector6::Zero());
  if (radiation_)
    for (std::size_t b = 0; b < bodies_.size(); ++b) loads[b] = radiation_->load_of_incident(b, solution.incident);
  std::size_t const n_fiber_node = fibers_.nodes().positions.size();
  solution.force_density.resize(n_fiber_node);
  answer(ConstPoints(solution.incident).first(n_fiber_node), loads, true, solution.force_density, solution.motions);
  return solution;
}

}  // namespace asterflow
