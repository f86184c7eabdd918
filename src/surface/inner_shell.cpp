#include "surface/inner_shell.hpp"

#include "surface/image_flows.hpp"
#include "surface/plane_image.hpp"

#include <cmath>

namespace asterflow {
namespace {

constexpr double largest = 0.9, smallest = 0.45, step = 0.05;  // of the scales tried
constexpr double margin = 0.5;  // other images than those of the measurement
constexpr int n_image = 24, n_target = 200;

// Images of forces of all directions that lie on the wall between nodes, spread over it.
struct Probe {
  std::vector<PlaneImage<double>> images;

  explicit Probe(Surface const& wall) {
    for (int i = 0; i < n_image; ++i) {
      std::size_t const node = (2 * i + 1) * wall.size() / (2 * n_image);
      Vec3d const between = 0.5 * (wall.nodes()[node] + wall.nodes()[(node + 1) % wall.size()]);
      ClosestPoint const at = wall.shape().closest_point(between);
      Vec3d const force{std::cos(2.4 * i), std::sin(2.4 * i) * std::cos(1.7 * i), std::sin(2.4 * i) * std::sin(1.7 * i)};
      images.emplace_back(force, at.position, -1.0 * at.normal, 0.05 * wall.spacing());
    }
  }
  PointArray flow(ConstPoints points) const {
    PointArray u(points.size());
    add_image_flows<double>("InnerShell::probe", images, {}, points, u);
    return u;
  }
};

double rms(ConstPoints u) { return flat(u).norm() / std::sqrt(static_cast<double>(u.size())); }

}  // namespace

InnerShell::InnerShell(std::shared_ptr<DirichletFlow const> interior, bool is_rough, double accuracy)
    : flow_(std::move(interior)), is_rough_(is_rough) {
  for (double scale = largest; scale > smallest; scale -= step) {
    set_scale(scale);
    if (error() <= margin * accuracy) return;
  }
  set_scale(0.0);
}

void InnerShell::set_scale(double scale) {
  Vec3d const centre = flow_->surface().shape().centre();
  scale_ = scale;
  nodes_.clear();
  for (Vec3d const& node : flow_->surface().nodes()) nodes_.push_back(centre + scale * (node - centre));
}

// At points spread evenly over the copy's inside.
double InnerShell::error() const {
  Probe const probe(flow_->surface());
  Shape const& shape = flow_->surface().shape();
  Vec3d const centre = shape.centre();
  PointArray targets, of_copy;
  for (int i = 0; i < n_target; ++i) {
    double const z = (2 * i + 1.0) / n_target - 1.0, r = std::sqrt(1.0 - z * z), phi = 2.39996 * i;
    Vec3d const on_wall = shape.image({r * std::cos(phi), r * std::sin(phi), z}).position;
    double const depth = std::cbrt(std::fmod(0.618034 * i + 0.5, 1.0));
    of_copy.push_back(centre + depth * (on_wall - centre));
    targets.push_back(centre + scale_ * (of_copy.back() - centre));
  }
  PointArray const expected = probe.flow(targets);
  PointArray difference(targets.size());
  continue_inwards(probe.flow(nodes_), flow_->plan(of_copy), difference);
  for (std::size_t i = 0; i < targets.size(); ++i) difference[i] -= expected[i];
  return rms(difference) / rms(expected);
}

void InnerShell::plan(DirichletFlow::Targets const& targets) {
  inside_.clear();
  if (scale_ > 0.0) targets.within(scale_, targets_, inside_);
}

void InnerShell::add_velocity(ConstPoints samples, Points velocity) const {
  PointArray flow(inside_.size());
  continue_inwards(samples, targets_, flow);
  for (std::size_t k = 0; k < inside_.size(); ++k) velocity[inside_[k]] += flow[k];
}

void InnerShell::continue_inwards(ConstPoints samples, DirichletFlow::Targets const& targets, Points velocity) const {
  if (is_rough_)
    flow_->add_rough_velocity(samples, targets, velocity);
  else
    flow_->add_velocity(samples, targets, velocity);
}

std::size_t InnerShell::memory() const {
  return sizeof(Vec3d) * nodes_.capacity() + sizeof(std::size_t) * inside_.capacity() + targets_.memory();
}

}  // namespace asterflow
