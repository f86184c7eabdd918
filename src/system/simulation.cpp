#include "system/simulation.hpp"

#include "base/error.hpp"
#include "base/timer.hpp"
#include "fiber/fiber_basis.hpp"
#include "system/population.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace asterflow {
namespace {

// A jump of a tip's force, which the step has taken up (late_share), looks like an error of the body's place: what of it counts.
constexpr double share_after_jump = 0.1;

// The fibers of a step as the scattering problem sees them.
class SteppedFibers final : public FiberAnswers {
 public:
  // motors: null without.
  SteppedFibers(Fibers const& fibers, CytoplasmicPulling const* motors) : fibers_(fibers), motors_(motors) {
    for (std::size_t i = 0; i <= fibers.count(); ++i) first_.push_back(fibers.first_node(i));
  }
  FiberNodes nodes() const override { return {fibers_.nodes(), fibers_.weights(), &first_}; }
  void add_linear_response(ConstPoints u, std::span<Vector6 const> motions, Points f,
                           std::span<Vector6> loads) const override {
    fibers_.add_linear_response(u, motions, f, loads);
  }
  void add_loads(ConstPoints u, std::span<Vector6> loads) const override { fibers_.add_loads(u, loads); }
  void add_own_flow(ConstPoints f, Points u) const override { fibers_.add_own_flow(f, u); }
  void add_affine_response(Points f, std::span<Vector6> loads) const override {
    fibers_.add_affine_response(f, loads);
  }
  void add_dipoles(Points f) const override {
    if (motors_) motors_->add_dipoles(fibers_, f);
  }
  void add_body_resistance(std::span<Matrix6> resistances) const override {
    fibers_.add_body_resistance(resistances);
  }

 private:
  Fibers const& fibers_;
  CytoplasmicPulling const* motors_;
  std::vector<std::size_t> first_;
};

}  // namespace

struct Simulation::Trial {
  double dt = 0.0;
  double error = 0.0;     // um
  std::string misplaced;  // what is not where it may be; then nothing else is known
  ScatteringSolution solution;
  std::vector<Vector6> contacts, applied;  // [n_body]
};

Simulation::Simulation(Scene scene)
    : scene_(std::move(scene)), fibers_(scene_.fluid.viscosity), placement_(scene_), flows_(make_flows(scene_)) {
  auto const& run = scene_.run;
  for (auto const& body : scene_.bodies) bodies_.emplace_back(body);
  if (scene_.background) background_.emplace(*scene_.background);
  if (scene_.cytoplasmic_pulling) cytoplasmic_pulling_.emplace(*scene_.cytoplasmic_pulling, scene_.fluid.viscosity);
  if (scene_.steric_repulsion) {
    std::vector<std::shared_ptr<Shape const>> shapes;
    for (auto const& body : scene_.bodies) shapes.push_back(make_shape(body.shape));
    steric_repulsion_.emplace(*scene_.steric_repulsion,
                              scene_.periphery ? make_shape(scene_.periphery->shape) : nullptr, std::move(shapes));
  }
  if (scene_.dynamic_instability) plus_ends_.emplace(scene_);
  add_scene_fibers(scene_, fibers_, plus_ends_);
  radiation_ = make_radiation(scene_, flows_);
  dt_ = run.time_step;
}

Simulation::~Simulation() = default;

// Loads of the fibers during the step, lengths and renucleation at the end of the step.
void Simulation::plan_fibers(double dt) {
  fibers_.begin_step();
  if (cytoplasmic_pulling_) cytoplasmic_pulling_->plan(fibers_);
  if (!plus_ends_) return;
  std::vector<RigidPose> poses;
  std::vector<Vector6> motions;
  for (auto const& body : bodies_) {
    poses.push_back(body.pose());
    motions.push_back(body.motion());
  }
  plus_ends_->plan(dt, fibers_, poses, motions);
}

// Contacts of fibers and bodies, for the incident flow that is expected; returns those of the bodies.
BodyContacts Simulation::hold_fibers(ConstPoints expected, std::vector<BodyMotionMap> const& maps) {
  BodyContacts contacts = this->contacts(maps);
  if (!plus_ends_ && !steric_repulsion_) return contacts;
  PointArray u(expected.begin(), expected.end());
  u.resize(fibers_.node_count());
  if (plus_ends_) plus_ends_->hold(fibers_, u, maps);
  if (!steric_repulsion_) return contacts;
  auto const local = [&] { return local_motions(expected, drives(maps, contacts), contacts.between); };
  auto const loads = steric_repulsion_->hold(fibers_, u, maps, local);
  for (std::size_t b = 0; b < loads.size(); ++b) contacts.loads[b].load += loads[b];
  return contacts;
}

LocalMotions Simulation::local_motions(ConstPoints expected, std::vector<BodyDrive> const& drives,
                                       Eigen::MatrixXd const& between) const {
  SteppedFibers const answers(fibers_, nullptr);
  Scattering alone(answers, drives, nullptr, nullptr, {});
  alone.couple(between);
  std::vector<Vector6> loads(drives.size(), Vector6::Zero());
  PointArray u(expected.begin(), expected.end()), force_density(fibers_.node_count());
  u.resize(fibers_.node_count());
  LocalMotions local;
  std::size_t first = fibers_.node_count();  // of the nodes of the body
  for (std::size_t b = 0; b < drives.size(); ++b) {
    std::size_t const n = flows_.bodies[b]->surface().size();
    if (radiation_ && !expected.empty())
      loads[b] = body_load(*flows_.bodies[b], drives[b].pose, scene_.fluid.viscosity, expected.subspan(first, n));
    first += n;
    local.resistances.push_back(drives[b].is_free ? alone.resistance(b) : Matrix6(Matrix6::Zero()));
  }
  alone.answer(u, loads, true, force_density, local.motions);
  return local;
}

TipState Simulation::tip_state(std::size_t fiber) const { return plus_ends_ ? plus_ends_->state_of(fiber) : TipState::still; }

std::size_t Simulation::exchange_memory() const {
  return radiation_ ? radiation_->memory() + memory_.memory() : 0;
}

Matrix6 Simulation::resistance_alone(std::size_t body, RigidPose const& pose) const {
  return body_resistance(*flows_.bodies[body], pose, scene_.fluid.viscosity);
}

BodyContacts Simulation::contacts(std::vector<BodyMotionMap> const& maps) const {
  if (steric_repulsion_) return steric_repulsion_->on_bodies(maps);
  return {.loads = std::vector<ContactLoad>(bodies_.size()), .between = {}};
}

std::vector<BodyDrive> Simulation::drives(std::vector<BodyMotionMap> const& maps,
                                          BodyContacts const& contacts) const {
  std::vector<BodyDrive> drives;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    auto const& body = bodies_[b];
    BodyDrive drive{maps[b].predicted, resistance_alone(b, maps[b].predicted),
                    body.is_free(), body.is_free() ? body.external_load() : body.prescribed_motion()};
    if (!radiation_ && background_ && body.is_free())  // otherwise the background is part of the incident flow
      drive.value += body_load(*flows_.bodies[b], drive.pose, scene_.fluid.viscosity, *background_);
    if (body.is_free()) {
      drive.resistance += contacts.loads[b].resistance;
      drive.value += contacts.loads[b].load;
    }
    drives.push_back(drive);
  }
  return drives;
}

// Extrapolated linearly from the two steps before, node by node; where that would change most of it (microtubules that were let go
// or caught in every step), the last flow, which is then no better a start of GMRES than none.
Simulation::Guess Simulation::guess(double dt) const {
  constexpr double large = 0.3;
  Guess guess{last_.incident, true};
  if (before_.incident.size() != last_.incident.size() || last_dt_ <= 0) return guess;
  auto const last = flat(ConstPoints(last_.incident)), before = flat(ConstPoints(before_.incident));
  double const ratio = dt / last_dt_;
  guess.is_close = ratio * (last - before).norm() <= large * last.norm();
  if (guess.is_close) flat(Points(guess.flow)) += ratio * (last - before);
  return guess;
}

std::string Simulation::misplaced_prediction(std::vector<BodyMotionMap> const& maps) const {
  std::vector<RigidPose> poses;
  for (auto const& map : maps) poses.push_back(map.predicted);
  std::string words = placement_.complaint(poses);
  if (!placement_.checks_fibers()) return words;
  for (std::size_t i = 0; i < fibers_.count() && words.empty(); ++i) {
    std::size_t const first = fibers_.first_node(i);
    words = placement_.complaint(i, fibers_.nodes().subspan(first, fibers_.first_node(i + 1) - first), poses);
  }
  return words;
}

std::string Simulation::misplaced_trial() const {
  std::vector<RigidPose> poses;
  for (auto const& body : bodies_) poses.push_back(body.trial_pose());
  std::string words = placement_.complaint(poses);
  if (!placement_.checks_fibers()) return words;
  PointArray positions;
  std::vector<double> coordinates;
  for (std::size_t i = 0; i < fibers_.count() && words.empty(); ++i) {
    Centreline const& shape = fibers_.trial_shape(i);
    auto const& nodes = fiber_basis(fibers_.properties(i).n_node).gauss.nodes;
    coordinates.clear();
    for (double alpha : nodes) coordinates.push_back(alpha * shape.length);
    coordinates.push_back(shape.length);
    positions.resize(coordinates.size());
    sample(shape, coordinates, positions, {});
    words = placement_.complaint(i, positions, poses);
  }
  return words;
}

ScatteringSolution Simulation::solve(ConstPoints guess, std::vector<BodyMotionMap> const& maps,
                                     BodyContacts const& contacts, StepReport& report) {
  Radiation::Seconds const before = radiation_ ? radiation_->seconds() : Radiation::Seconds{};
  Timer const timer;
  SteppedFibers const answers(fibers_, cytoplasmic_pulling_ ? &*cytoplasmic_pulling_ : nullptr);
  Scattering scattering(answers, drives(maps, contacts), radiation_.get(), &memory_,
                        {.tolerance = scene_.run.gmres_tolerance, .max_iterations = scene_.run.gmres_max_iterations});
  scattering.couple(contacts.between);
  auto const nodes = scattering.nodes();
  report.prepare_seconds += timer.seconds();
  PointArray imposed;
  if (background_) {
    imposed.assign(nodes.size(), Vec3d{});
    background_->add_velocity(nodes, imposed);
  }
  auto solution = scattering.solve(imposed, guess.size() == nodes.size() ? guess : ConstPoints{});
  if (radiation_) {
    report.sum_seconds += radiation_->seconds().sums - before.sums;
    report.surface_seconds += radiation_->seconds().surfaces - before.surfaces;
    report.rough_sum_seconds += radiation_->seconds().rough_sums - before.rough_sums;
    report.rough_surface_seconds += radiation_->seconds().rough_surfaces - before.rough_surfaces;
  }
  return solution;
}

void Simulation::advance(Trial& trial) {
  std::vector<RigidPose> poses;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    bodies_[b].advance(trial.solution.motions[b]);
    double const error = bodies_[b].error_estimate(outer_radius(bodies_[b].spec().shape));
    trial.error = std::max(trial.error, fibers_.has_jumped(static_cast<int>(b)) ? share_after_jump * error : error);
    poses.push_back(bodies_[b].trial_pose());
  }
  fibers_.advance(ConstPoints(trial.solution.incident).first(fibers_.node_count()), trial.solution.motions, poses);
  trial.error = std::max(trial.error, fibers_.error_estimate());
  if (plus_ends_) trial.error = std::max(trial.error, plus_ends_->error_estimate());
}

Simulation::Trial Simulation::attempt(double dt, StepReport& report) {
  Timer const timer;
  Trial trial{.dt = dt, .error = 0.0, .misplaced = {}, .solution = {}, .contacts = {}, .applied = {}};
  std::vector<BodyMotionMap> maps;
  for (auto& body : bodies_) maps.push_back(body.predict(dt));
  plan_fibers(dt);
  fibers_.prepare(dt, maps);
  Guess const expected = guess(dt);
  BodyContacts const contacts = hold_fibers(expected.flow, maps);
  trial.misplaced = misplaced_prediction(maps);
  report.prepare_seconds += timer.seconds();
  if (!trial.misplaced.empty()) return trial;
  trial.solution = solve(expected.is_close ? ConstPoints(expected.flow) : ConstPoints{}, maps, contacts, report);
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    trial.contacts.push_back(contacts.load(b, trial.solution.motions));
    trial.applied.push_back(bodies_[b].is_free() ? bodies_[b].external_load() : Vector6(trial.solution.holders[b] - trial.contacts[b]));
    if (!radiation_ && background_ && !bodies_[b].is_free())
      trial.applied[b] -= body_load(*flows_.bodies[b], maps[b].predicted, scene_.fluid.viscosity, *background_);
  }
  advance(trial);
  trial.misplaced = misplaced_trial();
  return trial;
}

void Simulation::accept(Trial&& trial) {
  for (auto& body : bodies_) body.accept();
  fibers_.accept();
  if (plus_ends_) plus_ends_->accept(fibers_);
  time_ += trial.dt;
  last_dt_ = trial.dt;
  before_ = std::move(last_);
  last_ = std::move(trial.solution);
  contacts_ = std::move(trial.contacts);
  applied_ = std::move(trial.applied);
}

// Why a trial step is not accepted; "" when it is.
std::string Simulation::objection(Trial const& trial) const {
  auto const& run = scene_.run;
  auto const& gmres = trial.solution.gmres;
  if (!trial.misplaced.empty()) return trial.misplaced;
  if (!gmres.converged)
    return fmt::format("GMRES stopped after {} iterations at residual {:.3g}", gmres.iterations, gmres.residual);
  if (run.adaptive && !(trial.error <= run.step_tolerance))
    return fmt::format("error {:.3g} um exceeds {:.3g} um", trial.error, run.step_tolerance);
  return {};
}

StepReport Simulation::step(double until) {
  Timer const timer;
  auto const& run = scene_.run;
  StepReport report;
  while (true) {
    bool const is_last = time_ + dt_ * (1 + 1e-9) >= until;
    double const dt = is_last ? until - time_ : dt_;
    Trial trial = attempt(dt, report);
    std::string const objection = this->objection(trial);
    bool const is_solved = trial.misplaced.empty() && trial.solution.gmres.converged;
    // The local error of a second-order step goes with dt^3.
    double const ideal = dt * std::clamp(0.9 * std::cbrt(run.step_tolerance / std::max(trial.error, 1e-300)), 0.3, 2.0);
    if (objection.empty()) {
      report.dt = dt;
      report.error = trial.error;
      report.iterations = trial.solution.gmres.iterations;
      report.inner_iterations = trial.solution.inner_iterations;
      report.residual = trial.solution.gmres.residual;
      if (run.adaptive && !(is_last && ideal < dt_)) dt_ = std::min(std::max(ideal, is_last ? dt_ : 0.0), run.max_time_step);
      accept(std::move(trial));
      if (is_last) time_ = until;
      report.time = time_;
      report.seconds = timer.seconds();
      return report;
    }
    ++report.rejected;
    dt_ = is_solved ? ideal : dt / 2;
    if (!run.adaptive || dt_ < run.min_time_step)
      throw NumericalError(
          fmt::format("t = {:.6g} s: no step down to dt = {:.3g} s is accepted: {}", time_, dt, objection));
  }
}

}  // namespace asterflow
