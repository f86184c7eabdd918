#pragma once
// Flow of a point force at many points at once (kernels/stokeslet.hpp).

#include "base/lanes.hpp"

namespace asterflow {

// u += 8 pi x flow at x of the force f at y; nothing at y itself.
template <class Real>
void add_stokeslet(LanesOfVectors<Real> const& x, Vec3<Real> y, Vec3<Real> f, LanesOfVectors<Real>& u) {
  LanesOfVectors<Real> const r{x.x - y.x, x.y - y.y, x.z - y.z};
  Lanes<Real> const r2 = r.x * r.x + r.y * r.y + r.z * r.z;
  Lanes<Real> const s = (r2 > Real(0)).select(r2.sqrt().inverse(), Real(0)), along_r = s * s * s * dot(f, r);
  u.x += s * f.x + along_r * r.x;
  u.y += s * f.y + along_r * r.y;
  u.z += s * f.z + along_r * r.z;
}

}  // namespace asterflow
