#include "system/deep_targets.hpp"

namespace asterflow {
namespace {

// The evaluation of a Dirichlet flow takes as long as this number of pairs of images and targets, per node and per target.
constexpr std::size_t pairs_per_node = 2000, pairs_per_target = 200;

}  // namespace

void DeepTargets::place(ConstPoints targets, DirichletFlow::Targets const& planned, std::size_t sources) {
  std::size_t const n_node = periphery_->surface().size();
  auto const is_worth_it = [&](std::size_t n_deep) {
    return n_deep > n_node && sources * (n_deep - n_node) > pairs_per_node * n_node + pairs_per_target * n_deep;
  };
  has_deep_ = false;
  if (is_worth_it(planned.size())) {
    if (!shell_) shell_.emplace(periphery_, is_rough_, accuracy_);
    shell_->plan(planned);
    has_deep_ = is_worth_it(shell_->inside().size());
  }
  points_.clear();
  shallow_.clear();
  if (!has_deep_) return;
  auto deep = shell_->inside().begin();
  for (std::size_t i = 0; i < targets.size(); ++i) {
    if (deep != shell_->inside().end() && *deep == i) {
      ++deep;
      continue;
    }
    shallow_.push_back(i);
    points_.push_back(targets[i]);
  }
  points_.insert(points_.end(), shell_->nodes().begin(), shell_->nodes().end());
}

void DeepTargets::add_velocity(std::function<void(ConstPoints, Points)> const& sum, ConstPoints targets, Points velocity) const {
  if (!has_deep_) return sum(targets, velocity);
  PointArray flow(points_.size());
  sum(points_, flow);
  for (std::size_t k = 0; k < shallow_.size(); ++k) velocity[shallow_[k]] += flow[k];
  shell_->add_velocity(ConstPoints(flow).subspan(shallow_.size()), velocity);
}

std::size_t DeepTargets::memory() const {
  return sizeof(Vec3d) * points_.capacity() + sizeof(std::size_t) * shallow_.capacity() + (shell_ ? shell_->memory() : 0);
}

}  // namespace asterflow
