#include "system/radiation.hpp"

#include "backends/evaluator.hpp"
#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/timer.hpp"
#include "kernels/stokeslet.hpp"
#include "system/own_sums.hpp"

#include <Eigen/LU>
#include <numeric>

namespace asterflow {

namespace {

constexpr double rough_accuracy = 1e-3;
constexpr double single_precision = 1e-5;  // from here on floats do
constexpr double rough_images = 4e-3;      // relative error of their flow deep inside
constexpr double largest_excess = 10.0;    // of the error of sums, in vectors whose flows cancel

PointArray to_body_frame(RigidPose const& pose, ConstPoints points) {
  PointArray local(points.size());
  Matrix3 const back = pose.rotation.transpose();
  for (std::size_t i = 0; i < points.size(); ++i) local[i] = back * (points[i] - pose.position);
  return local;
}

void add_flow(DirichletFlow const& flow, Exchange kind, ConstPoints wall_velocity, DirichletFlow::Targets const& targets,
              Points velocity) {
  if (kind == Exchange::rough)
    flow.add_rough_velocity(wall_velocity, targets, velocity);
  else
    flow.add_velocity(wall_velocity, targets, velocity);
}

Vector6 rotated(Matrix3 const& rotation, Vector6 const& v) {
  Vector6 result;
  result << rotation * v.head<3>(), rotation * v.tail<3>();
  return result;
}

}  // namespace

Radiation::Radiation(std::vector<Flow> body_flows, Flow periphery_flow, RadiationOptions options)
    : bodies_(std::move(body_flows)), periphery_(std::move(periphery_flow)), options_(std::move(options)) {
  for (Flow const& body : bodies_) {
    mobilities_.push_back(body->resistance().inverse());
    images_.emplace_back(ImageWall(body->surface(), Side::exterior, false));
  }
  if (periphery_ && options_.has_images_behind_periphery) {
    if (!options_.near_periphery) options_.near_periphery.emplace(periphery_->surface(), Side::interior, false);
    images_.emplace_back(*options_.near_periphery, options_.screened_forces);
    deep_targets_.emplace_back(periphery_, false, options_.accuracy);
    deep_targets_.emplace_back(periphery_, true, rough_images);
  }
}

Radiation::~Radiation() = default;

void Radiation::set_geometry(FiberNodes const& fibers, std::vector<RigidPose> const& poses) {
  ASTERFLOW_REQUIRE(poses.size() == bodies_.size());
  Timer const timer;
  poses_ = poses;
  place_nodes(fibers);
  plan_surfaces();
  if (n_fiber_nodes_ > 0) plan_fibers(fibers);
  seconds_.geometry += timer.seconds();
}

void Radiation::place_nodes(FiberNodes const& fibers) {
  n_fiber_nodes_ = fibers.positions.size();
  first_fiber_node_ = *fibers.first;
  weights_.assign(fibers.weights.begin(), fibers.weights.end());
  nodes_.assign(fibers.positions.begin(), fibers.positions.end());
  first_.clear();
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    first_.push_back(nodes_.size());
    for (Vec3d const& node : bodies_[b]->surface().nodes()) nodes_.push_back(poses_[b].point(node));
  }
  first_.push_back(nodes_.size());
  if (periphery_) nodes_.insert(nodes_.end(), periphery_->surface().nodes().begin(), periphery_->surface().nodes().end());
}

void Radiation::plan_body_targets(std::size_t body, BodyTargets& targets) const {
  PointArray points(nodes_.begin() + targets.first, nodes_.begin() + targets.gap);
  points.insert(points.end(), nodes_.begin() + targets.gap_end, nodes_.begin() + targets.last);
  bodies_[body]->plan(to_body_frame(poses_[body], points), targets.plan);
}

void Radiation::plan_surfaces() {
  std::size_t const begin = first_.front(), end = first_.back();  // of the bodies' nodes
  neighbours_.resize(bodies_.size());
  others_.resize(bodies_.size());
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    neighbours_[b].first = begin, neighbours_[b].last = end;
    neighbours_[b].gap = first_[b], neighbours_[b].gap_end = first_[b + 1];
    others_[b].first = 0, others_[b].last = nodes_.size();
    others_[b].gap = begin, others_[b].gap_end = end;
    plan_body_targets(b, neighbours_[b]);
    plan_body_targets(b, others_[b]);
  }
  if (periphery_) periphery_->plan(ConstPoints(nodes_).first(end), periphery_targets_);
}

void Radiation::plan_fibers(FiberNodes const& fibers) {
  auto const evaluator = [&](double accuracy) {
    return make_evaluator(Stokeslet::name, {.backend = options_.evaluator, .accuracy = accuracy, .largest_excess = largest_excess});
  };
  if (!stokeslets_) {
    stokeslets_ = evaluator(options_.accuracy);
    if (options_.accuracy < 0.5 * rough_accuracy) rough_stokeslets_ = evaluator(rough_accuracy);
  }
  stokeslets_->set_points(fibers.positions, nodes_);
  if (rough_stokeslets_) rough_stokeslets_->set_points(fibers.positions, nodes_);
  plan_images(fibers);
  close_nodes_.find(fibers.positions, fibers.weights, first_fiber_node_);
  strengths_.resize(n_fiber_nodes_);
}

void Radiation::plan_images(FiberNodes const& fibers) {
  if (options_.has_images_in_bodies)
    for (std::size_t b = 0; b < bodies_.size(); ++b)
      images_[b].place(poses_[b], fibers.positions, fibers.weights, first_fiber_node_);
  if (deep_targets_.empty()) return;
  images_.back().place({}, fibers.positions, fibers.weights, first_fiber_node_);
  auto const place = [&](bool is_rough, std::size_t n_image) {
    deep_targets_[is_rough].place(ConstPoints(nodes_).first(n_receiving_images(bodies_.size(), is_rough)), periphery_targets_, n_image);
  };
  place(false, images_.back().size());
  if (has_rough_exchange()) place(true, images_.back().n_merged());
}

Vector6 load_in_body_frame(DirichletFlow const& flow, RigidPose const& pose, ConstPoints incident) {
  Matrix3 const back = pose.rotation.transpose();
  PointArray local(incident.size());
  for (std::size_t i = 0; i < incident.size(); ++i) local[i] = back * incident[i];
  return flow.load(local);
}

Vector6 Radiation::load_in_body_frame(std::size_t body, ConstPoints incident) const {
  return asterflow::load_in_body_frame(*bodies_[body], poses_[body],
                                       incident.subspan(first_[body], first_[body + 1] - first_[body]));
}

Vector6 Radiation::load_of_incident(std::size_t body, ConstPoints incident) const {
  return rotated(poses_[body].rotation, options_.viscosity * load_in_body_frame(body, incident));
}

// When the flow at the nodes of a body becomes another.
Vector6 Radiation::motion_at_same_force(std::size_t body, Vector6 const& motion, ConstPoints before, ConstPoints now) const {
  Vector6 const change = load_in_body_frame(body, now) - load_in_body_frame(body, before);
  return motion + rotated(poses_[body].rotation, mobilities_[body] * change);
}

PointArray Radiation::wall_velocity(std::size_t body, Vector6 const& motion, ConstPoints incident) const {
  std::size_t const first = first_[body];
  Matrix3 const back = poses_[body].rotation.transpose();
  PointArray wall(first_[body + 1] - first);
  for (std::size_t i = 0; i < wall.size(); ++i)
    wall[i] = back * (velocity_of_motion(motion, nodes_[first + i] - poses_[body].position) - incident[first + i]);
  return wall;
}

PointArray Radiation::periphery_wall_velocity(ConstPoints incident) const {
  PointArray wall(incident.begin() + first_.back(), incident.end());
  for (Vec3d& u : wall) u = -u;
  return wall;
}

// The nodes of the periphery itself, which come last, take its images otherwise where these are accurate.
std::size_t Radiation::n_receiving_images(std::size_t wall, bool is_rough) const {
  return is_rough || wall < bodies_.size() ? nodes_.size() : first_.back();
}

void Radiation::add_images(bool is_rough, Points received) const {
  ConstPoints const nodes = nodes_;
  for (std::size_t i = 0; i < images_.size(); ++i) {
    std::size_t const n = n_receiving_images(i, is_rough);
    auto const sum = [&](ConstPoints targets, Points velocity) {
      if (is_rough)
        images_[i].add_rough_velocity(strengths_, targets, velocity);
      else if (options_.accuracy >= single_precision)
        images_[i].add_velocity<float>(strengths_, targets, velocity);
      else
        images_[i].add_velocity<double>(strengths_, targets, velocity);
    };
    if (i < bodies_.size())
      sum(nodes, received);
    else
      deep_targets_[is_rough].add_velocity(sum, nodes.first(n), received.first(n));
    if (n < nodes.size()) images_[i].add_velocity_at_wall(strengths_, nodes.subspan(n), received.subspan(n));
    images_[i].add_own_resolution(strengths_, nodes_, received);
  }
}

// Sum over all nodes of all fibers, less each fiber's sum over its own nodes: a fiber's own flow is its local drag.
void Radiation::add_fibers(ConstPoints force_density, Exchange kind, Points received) {
  double const scale = 1.0 / options_.viscosity;
  for (std::size_t i = 0; i < n_fiber_nodes_; ++i) strengths_[i] = (scale * weights_[i]) * force_density[i];
  bool const is_rough = kind == Exchange::rough && rough_stokeslets_;
  (is_rough ? rough_stokeslets_ : stokeslets_)->add_velocity(strengths_, received);
  add_images(is_rough, received);
  close_nodes_.add_correction(strengths_, received);
  auto const subtract = is_rough ? subtract_own_sums<float> : subtract_own_sums<double>;
  subtract(ConstPoints(nodes_).first(n_fiber_nodes_), first_fiber_node_, strengths_, received);
}

void Radiation::add_body(std::size_t body, Vector6 const& motion, ConstPoints incident, BodyTargets const& targets,
                         Exchange kind, Points received) const {
  PointArray flow(targets.plan.size());
  add_flow(*bodies_[body], kind, wall_velocity(body, motion, incident), targets.plan, flow);
  for (std::size_t i = 0; i < flow.size(); ++i) received[targets.node(i)] += poses_[body].rotation * flow[i];
}

void Radiation::add_periphery(ConstPoints incident, Exchange kind, Points received) {
  if (periphery_)
    add_flow(*periphery_, kind, periphery_wall_velocity(incident), periphery_targets_, received.first(first_.back()));
}

void Radiation::exchange(ConstPoints force_density, std::vector<Vector6> const& motions, std::vector<bool> const& is_free,
                         ConstPoints incident, Points received, Exchange kind) {
  ASTERFLOW_REQUIRE(incident.size() == nodes_.size() && received.size() == nodes_.size());
  Timer timer;
  bool const is_rough = kind == Exchange::rough;
  if (n_fiber_nodes_ > 0) add_fibers(force_density, kind, received);
  (is_rough ? seconds_.rough_sums : seconds_.sums) += timer.seconds();
  timer.restart();
  add_periphery(incident, kind, received);
  if (bodies_.size() > 1)
    for (std::size_t b = 0; b < bodies_.size(); ++b)
      add_body(b, motions[b], incident, neighbours_[b], kind, received);
  std::vector<Vector6> now = motions;
  for (std::size_t b = 0; b < now.size(); ++b)
    if (is_free[b]) now[b] = motion_at_same_force(b, motions[b], incident, received);
  for (std::size_t b = 0; b < bodies_.size(); ++b)  // `received` is complete at the bodies
    add_body(b, now[b], received, others_[b], kind, received);
  (is_rough ? seconds_.rough_surfaces : seconds_.surfaces) += timer.seconds();
}

void Radiation::add_velocity(ConstPoints force_density, std::vector<Vector6> const& motions, ConstPoints incident,
                             ConstPoints targets, Points velocity) const {
  if (n_fiber_nodes_ > 0) {
    auto const sum = make_evaluator(Stokeslet::name, {.backend = options_.evaluator, .accuracy = options_.accuracy});
    PointArray strengths(n_fiber_nodes_);
    for (std::size_t i = 0; i < n_fiber_nodes_; ++i)
      strengths[i] = (weights_[i] / options_.viscosity) * force_density[i];
    sum->set_points(ConstPoints(nodes_).first(n_fiber_nodes_), targets);
    sum->add_velocity(strengths, velocity);
    for (WallImages const& images : images_) images.add_velocity<double>(strengths, targets, velocity);
  }
  PointArray local(targets.size());
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    std::fill(local.begin(), local.end(), Vec3d{});
    bodies_[b]->add_velocity(wall_velocity(b, motions[b], incident), bodies_[b]->plan(to_body_frame(poses_[b], targets)),
                             local);
    for (std::size_t i = 0; i < local.size(); ++i) velocity[i] += poses_[b].rotation * local[i];
  }
  if (periphery_) periphery_->add_velocity(periphery_wall_velocity(incident), periphery_->plan(targets), velocity);
}

std::size_t Radiation::memory() const {
  std::size_t bytes = sizeof(Vec3d) * (nodes_.size() + strengths_.size()) + sizeof(double) * weights_.size();
  for (auto const& images : images_) bytes += images.memory();
  for (auto const& targets : deep_targets_) bytes += targets.memory();
  for (auto const& flow : bodies_) bytes += flow->memory();
  if (periphery_) bytes += periphery_->memory();
  return bytes + (stokeslets_ ? stokeslets_->memory() : 0) +
         (rough_stokeslets_ ? rough_stokeslets_->memory() : 0);
}

}  // namespace asterflow
