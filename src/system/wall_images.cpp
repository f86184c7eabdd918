#include "system/wall_images.hpp"

#include "base/parallel.hpp"
#include "kernels/stokeslet.hpp"
#include "surface/dirichlet_flow.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace asterflow {
namespace {

constexpr double negligible = 1e-3;  // nearness
constexpr double closest = 0.02;     // least distance over w: forces may lie on a body

// As many targets as fill a vector register are summed at once.
template <class Real>
constexpr long n_lane = 64 / sizeof(Real);
template <class Real>
using Lanes = Eigen::Array<Real, n_lane<Real>, 1>;
template <class Real>
struct LanesOfVectors {
  Lanes<Real> x = Lanes<Real>::Zero(), y = Lanes<Real>::Zero(), z = Lanes<Real>::Zero();
};

template <class Real>
Lanes<Real> dot(Vec3<Real> a, LanesOfVectors<Real> const& r) {
  return a.x * r.x + a.y * r.y + a.z * r.z;
}

// Targets first ... first + count - 1, the last one repeated.
template <class Real>
LanesOfVectors<Real> gather(ConstPoints targets, long first, long count) {
  LanesOfVectors<Real> x;
  for (int i = 0; i < n_lane<Real>; ++i) {
    Vec3d const target = targets[first + std::min<long>(i, count - 1)];
    x.x[i] = Real(target.x), x.y[i] = Real(target.y), x.z[i] = Real(target.z);
  }
  return x;
}

template <class Real>
Vec3<Real> to(Vec3d v) {
  return {Real(v.x), Real(v.y), Real(v.z)};
}

// The image of the force f at the distance d (um) from the wall.
template <class Real>
struct PointImage {
  Vec3<Real> position, f, a, e;
  Real d, twice_d_f_e;

  PointImage(Vec3d force, Vec3d foot, Vec3d normal, double distance)
      : position(to<Real>(foot - distance * normal)), f(to<Real>(force)),
        a(to<Real>(force - (2.0 * asterflow::dot(force, normal)) * normal)), e(to<Real>(normal)),
        d(Real(distance)), twice_d_f_e(Real(2.0 * distance * asterflow::dot(force, normal))) {}

  // u += 8 pi x flow at x.
  void add(LanesOfVectors<Real> const& x, LanesOfVectors<Real>& u) const {
    LanesOfVectors<Real> const r{x.x - position.x, x.y - position.y, x.z - position.z};
    Lanes<Real> const s = (r.x * r.x + r.y * r.y + r.z * r.z).rsqrt(), s2 = s * s, s3 = s * s2;
    Lanes<Real> const r_a = dot(a, r), twice = (d + d) * s3, along_a = (d - dot(e, r)) * twice, along_e = r_a * twice;
    Lanes<Real> const along_r = s3 * (twice_d_f_e - dot(f, r)) - (Real(3) * s2) * (along_a * r_a);
    u.x += along_r * r.x + a.x * along_a + e.x * along_e - f.x * s;
    u.y += along_r * r.y + a.y * along_a + e.y * along_e - f.y * s;
    u.z += along_r * r.z + a.z * along_a + e.z * along_e - f.z * s;
  }
};

template <class Real>
void scatter(LanesOfVectors<Real> const& u, long first, long count, Points velocity) {
  for (int i = 0; i < count; ++i) velocity[first + i] += Stokeslet::prefactor * Vec3d{double(u.x[i]), double(u.y[i]), double(u.z[i])};
}

}  // namespace

void WallImages::place(Surface const& wall, Side side, RigidPose const& pose, ConstPoints positions, ConstVector weights,
                       std::vector<std::size_t> const& first) {
  // Forces farther than 0.75 spacings are resolved to better than what curvature costs those at 0.2 spacings.
  // Images stay well within a thin body.
  double const size = wall.shape().size(), smallest = size / wall.shape().aspect_ratio();
  double const reach = std::min(0.75 * std::numbers::pi * size / wall.order(), 0.6 * smallest);
  is_body_ = side == Side::exterior;
  centre_ = pose.point(wall.shape().centre());
  double const outwards = is_body_ ? 1.0 : -1.0;
  std::vector<Image> all(positions.size());
  parallel_for("WallImages::place", static_cast<long>(first.size()) - 1, [&](long fiber) {
    for (std::size_t i = first[fiber]; i < first[fiber + 1]; ++i) {
      ClosestPoint const at = wall.shape().closest_point(pose.rotation.transpose() * (positions[i] - pose.position));
      double const distance = std::max(outwards * at.distance, closest * weights[i]);
      all[i] = {i, first[fiber], first[fiber + 1], pose.point(at.position), outwards * (pose.rotation * at.normal),
                std::exp(-std::pow(distance / reach, 8)), distance, std::max(distance, 0.5 * weights[i])};
    }
  });
  images_.clear();
  std::copy_if(all.begin(), all.end(), std::back_inserter(images_),
               [](Image const& image) { return image.nearness > negligible; });
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
  if (is_body_) add_centre(strengths, targets, velocity);
  std::vector<PointImage<Real>> images;
  for (Image const& image : images_)
    images.emplace_back(image.nearness * strengths[image.source], image.foot, image.normal, image.distance);
  auto const n = static_cast<long>(targets.size());
  parallel_for("WallImages::add_velocity", (n + n_lane<Real> - 1) / n_lane<Real>, [&](long block) {
    long const first = block * n_lane<Real>, count = std::min(n_lane<Real>, n - first);
    auto const x = gather<Real>(targets, first, count);
    LanesOfVectors<Real> u;
    for (auto const& image : images) image.add(x, u);
    scatter(u, first, count, velocity);
  });
}

template void WallImages::add_velocity<double>(ConstPoints, ConstPoints, Points) const;
template void WallImages::add_velocity<float>(ConstPoints, ConstPoints, Points) const;

void WallImages::add_own_resolution(ConstPoints strengths, ConstPoints positions, Points velocity) const {
  for (Image const& image : images_) {
    if (image.resolved == image.distance) continue;
    Vec3d const f = image.nearness * strengths[image.source];
    PointImage<double> const resolved(f, image.foot, image.normal, image.resolved),
        as_it_is(-f, image.foot, image.normal, image.distance);
    auto const end = static_cast<long>(image.end);
    for (auto first = static_cast<long>(image.first); first < end; first += n_lane<double>) {
      long const count = std::min(n_lane<double>, end - first);
      auto const x = gather<double>(positions, first, count);
      LanesOfVectors<double> u;
      resolved.add(x, u);
      as_it_is.add(x, u);
      scatter(u, first, count, velocity);
    }
  }
}

}  // namespace asterflow
