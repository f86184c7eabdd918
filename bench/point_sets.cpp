#include "bench/point_sets.hpp"

#include "base/error.hpp"
#include "base/random.hpp"

#include <algorithm>
#include <cmath>

namespace asterflow::bench {
namespace {

Vec3d random_vector(long i, int stream) {
  return {uniform_random(7, i, stream, 0) - 0.5, uniform_random(7, i, stream, 1) - 0.5,
          uniform_random(7, i, stream, 2) - 0.5};
}

Vec3d random_direction(long i, int stream) {
  double const z = 2.0 * uniform_random(7, i, stream, 0) - 1.0, angle = 2.0 * M_PI * uniform_random(7, i, stream, 1);
  double const across = std::sqrt(1.0 - z * z);
  return {across * std::cos(angle), across * std::sin(angle), z};
}

Vec3d aster_point(long i, long n) {
  long const n_fiber = std::min(1000L, n), per_fiber = (n + n_fiber - 1) / n_fiber;
  Vec3d const d = random_direction(i % n_fiber, 0);
  double const wall = 1.0 / std::sqrt(d.x * d.x / 625.0 + (d.y * d.y + d.z * d.z) / 225.0);
  double const fraction = (static_cast<double>(i / n_fiber) + 0.5) / static_cast<double>(per_fiber);
  return (5.0 + (wall - 5.0) * fraction) * d;
}

}  // namespace

std::vector<std::string> distributions() { return {"uniform", "sphere", "aster", "line", "clusters"}; }

PointArray points(std::string const& distribution, long n) {
  PointArray x(n);
  for (long i = 0; i < n; ++i) {
    if (distribution == "uniform")
      x[i] = random_vector(i, 0);
    else if (distribution == "sphere")
      x[i] = random_direction(i, 0);
    else if (distribution == "aster")
      x[i] = aster_point(i, n);
    else if (distribution == "line")
      x[i] = random_vector(i, 0).x * Vec3d{1.0, 0.7, -0.3};
    else if (distribution == "clusters")
      x[i] = random_vector(i, 0) + Vec3d{i % 2 == 0 ? 0.0 : 1e4, 0.0, 0.0};
    else
      throw SceneError("distribution: unknown \"" + distribution + "\"");
  }
  return x;
}

PointArray strengths(long n) {
  PointArray f(n);
  for (long i = 0; i < n; ++i) f[i] = random_vector(i, 1);
  return f;
}

PointArray normals(long n) {
  PointArray v(n);
  for (long i = 0; i < n; ++i) v[i] = random_direction(i, 2);
  return v;
}

}  // namespace asterflow::bench
