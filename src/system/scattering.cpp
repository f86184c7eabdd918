#include "system/scattering.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cmath>

namespace asterflow {

Scattering::Scattering(FiberAnswers const& fibers, std::vector<BodyDrive> bodies, Radiation* radiation,
                       Recycling* memory, ScatteringOptions options)
    : fibers_(fibers), bodies_(std::move(bodies)), radiation_(radiation), memory_(memory), options_(options) {
  std::vector<Matrix6> resistances;
  std::vector<RigidPose> poses;
  for (auto const& body : bodies_) {
    resistances.push_back(body.resistance);
    poses.push_back(body.pose);
    is_free_.push_back(body.is_free);
  }
  fibers_.add_body_resistance(resistances);
  for (auto const& resistance : resistances) held_resistance_.emplace_back(resistance);
  if (radiation_) radiation_->set_geometry(fibers_.nodes(), poses);
}

ConstPoints Scattering::nodes() const { return radiation_ ? radiation_->nodes() : fibers_.nodes().positions; }

void Scattering::couple(Eigen::MatrixXd const& between) {
  if (between.size() == 0) return;
  Eigen::MatrixXd system = between;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    Eigen::Index const row = static_cast<Eigen::Index>(6 * b);
    if (!bodies_[b].is_free) system.middleRows<6>(row).setZero();
    system.block<6, 6>(row, row) = bodies_[b].is_free ? resistance(b) : Matrix6(Matrix6::Identity());
  }
  coupled_.emplace(system);
}

// For loads that come with the flow; affine: and those that do not.
void Scattering::move_bodies(std::vector<Vector6> const& loads, bool affine, std::vector<Vector6>& motions) const {
  Eigen::VectorXd all(static_cast<Eigen::Index>(6 * bodies_.size()));
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    Vector6 value = affine ? bodies_[b].value : Vector6(Vector6::Zero());
    if (bodies_[b].is_free) value += loads[b];
    motions[b] = bodies_[b].is_free && !coupled_ ? Vector6(held_resistance_[b].solve(value)) : value;
    all.segment<6>(static_cast<Eigen::Index>(6 * b)) = value;
  }
  if (!coupled_) return;
  all = coupled_->solve(all).eval();
  for (std::size_t b = 0; b < bodies_.size(); ++b) motions[b] = all.segment<6>(static_cast<Eigen::Index>(6 * b));
}

// What the flow and the fibers on a prescribed body leave to whatever moves it.
std::vector<Vector6> Scattering::holders(ConstPoints u, std::vector<Vector6> loads, std::span<Vector6 const> motions) const {
  std::vector<Vector6> result(bodies_.size(), Vector6::Zero());
  if (std::ranges::all_of(bodies_, &BodyDrive::is_free)) return result;
  PointArray force_density(u.size());
  fibers_.add_affine_response(force_density, loads);
  fibers_.add_loads(u, loads);
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    if (!bodies_[b].is_free) result[b] = resistance(b) * motions[b] - loads[b];
  return result;
}

void Scattering::answer(ConstPoints u, std::vector<Vector6> loads, bool affine, Points force_density,
                        std::vector<Vector6>& motions) const {
  motions.assign(bodies_.size(), Vector6::Zero());
  std::fill(force_density.begin(), force_density.end(), Vec3d{});
  if (affine) fibers_.add_affine_response(force_density, loads);
  if (!bodies_.empty()) fibers_.add_loads(u, loads);
  move_bodies(loads, affine, motions);
  fibers_.add_linear_response(u, motions, force_density, {});
}

void Scattering::add_answer(ConstPoints z, bool affine, Points received, Exchange kind) const {
  std::vector<Vector6> loads, motions;
  for (std::size_t b = 0; b < bodies_.size(); ++b) loads.push_back(radiation_->load_of_incident(b, z));
  PointArray force_density(radiation_->n_fiber_nodes());
  answer(z.first(force_density.size()), loads, affine, force_density, motions);
  fibers_.add_own_flow(force_density, received.first(force_density.size()));
  if (affine) fibers_.add_dipoles(force_density);
  radiation_->exchange(force_density, motions, is_free_, z, received, kind);
}

void Scattering::apply_equation(ConstVector z, Vector result, Exchange kind) const {
  std::fill(result.begin(), result.end(), 0.0);
  add_answer(as_points(z), false, as_points(result), kind);
  for (std::size_t i = 0; i < z.size(); ++i) result[i] = z[i] - result[i];
}

namespace {

// Keeps what an operator was applied to and what came out.
class Recorder {
 public:
  explicit Recorder(LinearOperator a) : a_(std::move(a)) {}
  void operator()(ConstVector input, Vector output) {
    a_(input, output);
    inputs_.insert(inputs_.end(), input.begin(), input.end());
    outputs_.insert(outputs_.end(), output.begin(), output.end());
    ++count_;
  }
  void teach(Recycling& memory, double digits_gained) const {
    if (count_ == 0) return;
    Eigen::Index const n = static_cast<Eigen::Index>(inputs_.size()) / count_;
    memory.learn(Eigen::Map<Eigen::MatrixXf const>(inputs_.data(), n, count_),
                 Eigen::Map<Eigen::MatrixXf const>(outputs_.data(), n, count_),
                 static_cast<double>(count_) / std::max(digits_gained, 0.5));
  }

 private:
  LinearOperator a_;
  std::vector<float> inputs_, outputs_;
  Eigen::Index count_ = 0;
};

}  // namespace

// Solves (I - L) correction = residual to tolerance x reference.
GmresResult Scattering::correct(ConstVector residual, double reference, Vector correction, int& inner_iterations) {
  GmresOptions options{.tolerance = options_.tolerance, .reference = reference, .max_iterations = options_.max_iterations};
  LinearOperator const recall = [this](ConstVector r, Vector result) {
    std::copy(r.begin(), r.end(), result.begin());
    if (memory_) memory_->precondition(result);
  };
  bool const is_nested = radiation_->has_rough_exchange();
  Recorder equation([&](ConstVector z, Vector result) {
    apply_equation(z, result, is_nested ? Exchange::rough : Exchange::accurate);
  });
  GmresResult result;
  if (is_nested) {
    auto const accurate = [&](ConstVector z, Vector result) { apply_equation(z, result, Exchange::accurate); };
    double to_go = 1.0;  // what remains to be gained
    options.monitor = [&](double outer_residual) { to_go = options_.tolerance / outer_residual; };
    auto const rough_solve = [&](ConstVector r, Vector result) {
      std::fill(result.begin(), result.end(), 0.0);
      double const solves_to_go = std::max(1.0, std::ceil(std::log(to_go) / std::log(options_.rough_gain)));
      inner_iterations += solve_gmres(std::ref(equation), recall, r, result,
                                      {.tolerance = 0.7 * std::pow(std::min(to_go, 1.0), 1.0 / solves_to_go),
                                       .max_iterations = options_.max_iterations})
                              .iterations;
    };
    result = solve_gmres(accurate, rough_solve, residual, correction, options);
  } else {
    result = solve_gmres(std::ref(equation), recall, residual, correction, options);
  }
  double const initial = flat(as_points(residual)).norm() / reference;
  if (memory_) equation.teach(*memory_, std::log10(initial / std::max(result.residual, 1e-300)));
  return result;
}

ScatteringSolution Scattering::solve(ConstPoints background, ConstPoints guess) {
  ScatteringSolution solution;
  std::size_t const n = nodes().size();
  solution.incident.assign(n, Vec3d{});
  if (radiation_) {
    PointArray image(n), correction(n);
    auto const apply_to_incident = [&](Exchange kind) {  // image = L z + b
      std::fill(image.begin(), image.end(), Vec3d{});
      std::copy(background.begin(), background.end(), image.begin());
      add_answer(solution.incident, true, image, kind);
    };
    apply_to_incident(guess.empty() ? Exchange::accurate : Exchange::rough);  // b; of the residual without a guess, else its size
    double const scale = flat(ConstPoints(image)).norm();
    if (!guess.empty()) {
      std::copy(guess.begin(), guess.end(), solution.incident.begin());
      apply_to_incident(Exchange::accurate);
      for (std::size_t i = 0; i < n; ++i) image[i] -= guess[i];
    }
    solution.gmres = correct(as_vector(image), scale, as_vector(correction), solution.inner_iterations);
    for (std::size_t i = 0; i < n; ++i) solution.incident[i] += correction[i];
  } else {
    std::copy(background.begin(), background.end(), solution.incident.begin());
    solution.gmres.converged = true;
  }
  std::vector<Vector6> loads(bodies_.size(), Vector6::Zero());
  if (radiation_)
    for (std::size_t b = 0; b < bodies_.size(); ++b) loads[b] = radiation_->load_of_incident(b, solution.incident);
  ConstPoints const fiber_nodes = fibers_.nodes().positions;
  std::size_t const n_fiber_node = fiber_nodes.size();
  solution.fiber_nodes.assign(fiber_nodes.begin(), fiber_nodes.end());
  for (auto const& body : bodies_) solution.poses.push_back(body.pose);
  solution.force_density.resize(n_fiber_node);
  ConstPoints const at_fibers = ConstPoints(solution.incident).first(n_fiber_node);
  answer(at_fibers, loads, true, solution.force_density, solution.motions);
  solution.holders = holders(at_fibers, loads, solution.motions);
  fibers_.add_dipoles(solution.force_density);
  return solution;
}

}  // namespace asterflow
