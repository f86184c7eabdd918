#include "backends/point_cloud.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cmath>

namespace asterflow {
namespace {

constexpr double largest_coordinate = 1e100;  // its fifth power still fits in a double, nearly

bool is_usable(Vec3d x) {
  return std::abs(x.x) <= largest_coordinate && std::abs(x.y) <= largest_coordinate &&
         std::abs(x.z) <= largest_coordinate;
}

void extend(Bounds& box, ConstPoints points, char const* what) {
  for (Vec3d const& x : points) {
    if (!is_usable(x))
      throw SceneError(std::string(what) + ": point " + std::to_string(&x - points.data()) + " = (" +
                       std::to_string(x.x) + ", " + std::to_string(x.y) + ", " + std::to_string(x.z) +
                       ") is not finite or beyond 1e100");
    for (int c = 0; c < 3; ++c) {
      box.lower[c] = std::min(box.lower[c], x[c]);
      box.upper[c] = std::max(box.upper[c], x[c]);
    }
  }
}

// A point and its place along a direction that no common arrangement of points is perpendicular to.
struct Projected {
  double place;
  Vec3d point;
  explicit Projected(Vec3d x) : place(dot(x, Vec3d{0.5477, 0.6124, 0.5701})), point(x) {}
  bool operator<(Projected const& other) const {
    if (place != other.place) return place < other.place;
    if (point.x != other.point.x) return point.x < other.point.x;
    if (point.y != other.point.y) return point.y < other.point.y;
    return point.z < other.point.z;
  }
  bool operator==(Projected const& other) const {
    return point.x == other.point.x && point.y == other.point.y && point.z == other.point.z;
  }
};

}  // namespace

double Bounds::extent() const {
  Vec3d const edge = upper - lower;
  return std::max({edge.x, edge.y, edge.z});
}

Bounds bounding_box(ConstPoints sources, ConstPoints targets) {
  if (sources.empty() && targets.empty()) return {};
  Vec3d const first = sources.empty() ? targets.front() : sources.front();
  Bounds box{first, first};
  extend(box, sources, "sources");
  extend(box, targets, "targets");
  return box;
}

bool dwarfs_sources(Bounds const& all, ConstPoints sources, ConstPoints targets) {
  constexpr double most = 1e20;  // pairs closer than 5e-38 of the extent are lost, here below rounding of the sources
  if (sources.empty()) return false;
  double size = bounding_box(sources, {}).extent();
  if (size == 0.0) {
    size = all.extent();
    for (Vec3d const& x : targets) {
      Vec3d const r = x - sources.front();
      double const distance = std::max({std::abs(r.x), std::abs(r.y), std::abs(r.z)});
      if (distance > 0.0) size = std::min(size, distance);
    }
  }
  return all.extent() > most * size;
}

bool has_close_pair(ConstPoints sources, ConstPoints targets, double distance) {
  Vec3d const origin = bounding_box(sources, targets).centre();
  std::vector<Projected> points;
  points.reserve(sources.size() + targets.size());
  for (auto const& x : sources) points.emplace_back(x - origin);
  for (auto const& x : targets) points.emplace_back(x - origin);
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());

  auto const n = points.size();
  std::size_t const patience = 64 * n;
  double const slack = 1e-15 * bounding_box(sources, targets).extent();  // rounding of `place`
  std::size_t n_compared = 0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n && points[j].place - points[i].place <= distance + slack; ++j) {
      if (norm(points[j].point - points[i].point) < distance) return true;
      if (++n_compared > patience) return true;
    }
  return false;
}

}  // namespace asterflow
