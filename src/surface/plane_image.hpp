#pragma once
// Image of a point force f behind a plane wall at rest [Blake 1971, Eq. 9]: at the distance d from a wall with the normal e
// into the fluid, force and image together,
//   u = G f - G' f - 2 d (a . grad) G' e + d^2 lap G' a,   a = f - 2 (f . e) e,
// G the Stokeslet of viscosity 1 at the force, G' at the mirrored point, vanish on the wall.

#include "base/lanes.hpp"

namespace asterflow {

template <class Real>
class PlaneImage {
 public:
  // foot: the point of the wall closest to the force.
  PlaneImage(Vec3d force, Vec3d foot, Vec3d normal, double distance)
      : position_(to_real(foot - distance * normal)), f_(to_real(force)), e_(to_real(normal)), d_(Real(distance)),
        twice_d_f_e_(Real(2.0 * distance * asterflow::dot(force, normal))),
        twice_f_e_(Real(2.0 * asterflow::dot(force, normal))) {}

  // u += 8 pi x flow of the image at x.
  void add(LanesOfVectors<Real> const& x, LanesOfVectors<Real>& u) const {
    LanesOfVectors<Real> const r{x.x - position_.x, x.y - position_.y, x.z - position_.z};
    Lanes<Real> const s = (r.x * r.x + r.y * r.y + r.z * r.z).rsqrt(), s2 = s * s, s3 = s * s2;
    Lanes<Real> const r_e = asterflow::dot(e_, r), r_f = asterflow::dot(f_, r), r_a = r_f - twice_f_e_ * r_e;
    Lanes<Real> const twice = (d_ + d_) * s3, along_a = (d_ - r_e) * twice;
    Lanes<Real> const along_r = s3 * (twice_d_f_e_ - r_f) - (Real(3) * s2) * (along_a * r_a);
    Lanes<Real> const along_f = along_a - s, along_e = r_a * twice - twice_f_e_ * along_a;
    u.x = r.x * along_r + (f_.x * along_f + (e_.x * along_e + u.x));
    u.y = r.y * along_r + (f_.y * along_f + (e_.y * along_e + u.y));
    u.z = r.z * along_r + (f_.z * along_f + (e_.z * along_e + u.z));
  }

 private:
  static Vec3<Real> to_real(Vec3d v) { return {Real(v.x), Real(v.y), Real(v.z)}; }

  Vec3<Real> position_, f_, e_;
  Real d_, twice_d_f_e_, twice_f_e_;
};

}  // namespace asterflow
