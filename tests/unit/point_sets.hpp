#pragma once
// Random points with strengths for tests of pair sums.

#include "base/arrays.hpp"
#include "base/random.hpp"

#include <string>
#include <string_view>

namespace asterflow {

// Components in (-0.5, 0.5).
inline Vec3d random_vector(long i, int stream) {
  return {uniform_random(1, i, stream, 0) - 0.5, uniform_random(1, i, stream, 1) - 0.5, uniform_random(1, i, stream, 2) - 0.5};
}

inline Vec3d random_point(std::string const& distribution, long i) {
  Vec3d const p = random_vector(i, 0);
  if (distribution == "sphere") return 7.0 * normalized(p);
  if (distribution == "line") return p.x * Vec3d{3.0, -2.0, 0.5};
  if (distribution == "plane") return {p.x, 2.0 * p.y, 0.0};
  if (distribution == "clusters") return p + Vec3d{i % 2 == 0 ? 0.0 : 1e4, 0.0, 3.0};
  if (distribution == "fibers") return (5.0 + 10.0 * (p.x + 0.5)) * normalized(random_vector(i % 20, 7));
  if (distribution == "nearly touching") return random_vector(i / 2, 0) + (i % 2 == 0 ? 1e-10 : 0.0) * Vec3d{1.0, 2.0, 0.0};
  return p;
}

struct PointSet {
  PointArray sources, targets, strengths, normals;  // normals for kernels that have them
};

// Targets are the sources.
inline PointSet point_set(std::string_view kernel, std::string const& distribution, long n) {
  PointSet set;
  for (long i = 0; i < n; ++i) {
    set.sources.push_back(random_point(distribution, i));
    set.strengths.push_back(random_vector(i, 1));
    if (kernel.starts_with("stresslet")) set.normals.push_back(normalized(random_vector(i, 2)));
  }
  set.targets = set.sources;
  return set;
}

// In a cube, with targets of their own.
inline PointSet point_set(std::string_view kernel, long n_source, long n_target) {
  PointSet set = point_set(kernel, "uniform", n_source);
  set.targets.clear();
  for (long i = 0; i < n_target; ++i) set.targets.push_back(random_vector(i, 3));
  return set;
}

// Of the L2 norms of a - exact and exact.
inline double relative_difference(PointArray const& a, PointArray const& exact) {
  return (flat(ConstPoints(a)) - flat(ConstPoints(exact))).norm() / flat(ConstPoints(exact)).norm();
}

}  // namespace asterflow
