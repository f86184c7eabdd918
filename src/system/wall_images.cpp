#include "system/wall_images.hpp"

#include "base/parallel.hpp"
#include "kernels/stokeslet.hpp"
#include "surface/curvature_image.hpp"
#include "surface/image_flows.hpp"
#include "surface/plane_image.hpp"
#include "system/stokeslet_lanes.hpp"

#include <algorithm>
#include <cmath>

namespace asterflow {
namespace {

constexpr double negligible = 1e-3;  // nearness
constexpr double closest = 1e-3;     // least distance over w: forces may lie on the wall
constexpr double merging = 0.5;      // distance of images that merge, over that from the wall

}  // namespace

std::shared_ptr<ScreenedForces const> make_screened_forces(ImageWall const& periphery, double accuracy) {
  return periphery.surface().axisymmetric() ? std::make_shared<ScreenedForces const>(periphery, accuracy) : nullptr;
}

WallImages::WallImages(ImageWall const& wall, std::shared_ptr<ScreenedForces const> screened)
    : wall_(wall), screened_(std::move(screened)) {}

void WallImages::place(RigidPose const& pose, ConstPoints positions, ConstVector weights, std::vector<std::size_t> const& first) {
  Shape const& shape = wall_.surface().shape();
  centre_ = pose.point(shape.centre());
  double const outwards = wall_.is_body() ? 1.0 : -1.0;
  std::vector<Image> all(positions.size());
  parallel_for("WallImages::place", static_cast<long>(first.size()) - 1, [&](long fiber) {
    for (std::size_t i = first[fiber]; i < first[fiber + 1]; ++i) {
      ClosestPoint const at = shape.closest_point(pose.rotation.transpose() * (positions[i] - pose.position));
      double const distance = std::max(outwards * at.distance, closest * weights[i]);
      if (distance > ImageWall::deepest * wall_.largest_reach()) continue;
      LocalGeometry const local = local_geometry(shape, at.direction);
      double const depth = distance / wall_.reach(local);
      all[i] = {i, first[fiber], first[fiber + 1], positions[i], pose.point(at.position), at.direction,
                outwards * (pose.rotation * at.normal), local, depth, std::exp(-std::pow(depth, 8)), distance,
                std::max(distance, 0.5 * weights[i])};
    }
  });
  images_.clear();
  places_.clear();
  std::copy_if(all.begin(), all.end(), std::back_inserter(images_),
               [](Image const& image) { return image.nearness > negligible; });
  if (screened_)
    for (Image const& image : images_) places_.push_back(screened_->locate(image.direction, image.depth));
  merge();
}

// The last image of the same fiber, without a gap, that is close to `first` for all from there on.
std::size_t WallImages::last_to_merge(std::size_t first) const {
  std::size_t last = first;
  double nearest = images_[first].distance;
  while (last + 1 < images_.size() && images_[last + 1].source == images_[last].source + 1 &&
         images_[last + 1].first == images_[first].first) {
    nearest = std::min(nearest, images_[last + 1].distance);
    if (norm(images_[last + 1].position - images_[first].position) > merging * nearest) break;
    ++last;
  }
  return last;
}

// Those in between give their forces to the two ends, in parts that keep the centre of the force.
void WallImages::merge() {
  merged_.clear();
  shares_.clear();
  for (std::size_t first = 0; first < images_.size();) {
    std::size_t const last = last_to_merge(first);
    if (shares_.size() == first) {
      merged_.push_back(first);
      shares_.push_back({{merged_.size() - 1, merged_.size() - 1}, 0.0});
    }
    if (last == first) {
      ++first;
      continue;
    }
    merged_.push_back(last);
    Vec3d const between = images_[last].position - images_[first].position;
    for (std::size_t i = first + 1; i <= last; ++i)
      shares_.push_back({{merged_.size() - 2, merged_.size() - 1},
                         dot(images_[i].position - images_[first].position, between) / dot(between, between)});
    first = last;
  }
}

WallImages::Moments WallImages::moments(ConstPoints strengths) const {
  Moments sum;
  for (Image const& image : images_) {
    Vec3d const e = image.normal, f = image.nearness * strengths[image.source], a = f - 2.0 * dot(f, e) * e;
    sum.force -= f;
    sum.first += -to_eigen(image.foot - image.distance * e - centre_) * to_eigen(f).transpose() +
                 2.0 * image.distance * to_eigen(a) * to_eigen(e).transpose();
  }
  return sum;
}

// Minus force, torque L and symmetric traceless moment S of the images, at the centre:
//   u = (1 / 8 pi) (F / r + r (r . F) / r^3 + L x r / r^3 + 3 r (r . S r) / r^5).
void WallImages::add_centre(ConstPoints strengths, ConstPoints targets, Points velocity) const {
  Moments const sum = moments(strengths);
  Vec3d const force = -sum.force;
  Matrix3 const& m = sum.first;
  Vec3d const torque = -Vec3d{m(1, 2) - m(2, 1), m(2, 0) - m(0, 2), m(0, 1) - m(1, 0)};
  Matrix3 const stresslet = -0.5 * (m + m.transpose()) + (m.trace() / 3.0) * Matrix3::Identity();
  parallel_for("WallImages::centre", static_cast<long>(targets.size()), [&](long i) {
    Vec3d const r = targets[i] - centre_;
    double const s2 = 1.0 / dot(r, r), s = std::sqrt(s2), s3 = s * s2;
    velocity[i] += Stokeslet::prefactor * (s * force + s3 * cross(torque, r) +
                                           s3 * (dot(r, force) + 3.0 * s2 * dot(r, stresslet * r)) * r);
  });
}

template <class Real>
void WallImages::add_velocity(ConstPoints strengths, ConstPoints targets, Points velocity) const {
  if (images_.empty()) return;
  if (wall_.is_body()) add_centre(strengths, targets, velocity);
  std::vector<PlaneImage<Real>> images;
  for (Image const& image : images_)
    images.emplace_back(image.nearness * strengths[image.source], image.foot - centre_, image.normal, image.distance);
  add_image_flows<Real>("WallImages::plane", images, centre_, targets, velocity);
  if (!wall_.has_curvature()) return;
  std::vector<CurvatureImage<float>> bent;  // a small part, to first order: float is enough
  for (Image const& image : images_)
    bent.emplace_back(image.nearness * strengths[image.source], image.foot - centre_, image.normal, image.distance, image.shape);
  add_image_flows<float>("WallImages::curvature", bent, centre_, targets, velocity);
}

void WallImages::add_rough_velocity(ConstPoints strengths, ConstPoints targets, Points velocity) const {
  if (images_.empty()) return;
  if (wall_.is_body()) add_centre(strengths, targets, velocity);
  PointArray forces(merged_.size());
  for (std::size_t i = 0; i < images_.size(); ++i) {
    Vec3d const force = images_[i].nearness * strengths[images_[i].source];
    forces[shares_[i].to[0]] += (1.0 - shares_[i].second) * force;
    forces[shares_[i].to[1]] += shares_[i].second * force;
  }
  std::vector<PlaneImage<float>> images;
  for (std::size_t k = 0; k < forces.size(); ++k) {
    Image const& image = images_[merged_[k]];
    images.emplace_back(forces[k], image.foot - centre_, image.normal, image.distance);
  }
  add_image_flows<float>("WallImages::merged", images, centre_, targets, velocity);
}

template void WallImages::add_velocity<double>(ConstPoints, ConstPoints, Points) const;
template void WallImages::add_velocity<float>(ConstPoints, ConstPoints, Points) const;

void WallImages::add_velocity_at_wall(ConstPoints strengths, ConstPoints wall_nodes, Points velocity) const {
  if (!screened_) return add_velocity<double>(strengths, wall_nodes, velocity);
  PointArray forces;
  for (Image const& image : images_) forces.push_back(image.nearness * strengths[image.source]);
  auto const n = static_cast<long>(wall_nodes.size());
  parallel_for("WallImages::samples", (n + n_lane<double> - 1) / n_lane<double>, [&](long block) {
    long const first = block * n_lane<double>, count = std::min(n_lane<double>, n - first);
    auto const x = gather<double>(wall_nodes, first, count);
    LanesOfVectors<double> sampled;
    for (std::size_t j = 0; j < forces.size(); ++j) add_stokeslet(x, images_[j].position, forces[j], sampled);
    add_lanes(-Stokeslet::prefactor, sampled, first, count, velocity);
  });
  screened_->add_velocity(places_, forces, velocity);
}

void WallImages::add_own_resolution(ConstPoints strengths, ConstPoints positions, Points velocity) const {
  for (Image const& image : images_) {
    if (image.resolved == image.distance) continue;
    Vec3d const f = image.nearness * strengths[image.source];
    PlaneImage<double> const resolved(f, image.foot, image.normal, image.resolved),
        as_it_is(-f, image.foot, image.normal, image.distance);
    auto const end = static_cast<long>(image.end);
    for (auto first = static_cast<long>(image.first); first < end; first += n_lane<double>) {
      long const count = std::min(n_lane<double>, end - first);
      auto const x = gather<double>(positions, first, count);
      LanesOfVectors<double> u;
      resolved.add(x, u);
      as_it_is.add(x, u);
      add_lanes(Stokeslet::prefactor, u, first, count, velocity);
    }
  }
}

}  // namespace asterflow
