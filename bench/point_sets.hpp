#pragma once
// Point distributions for the benchmarks of pair sums; every point is a pure function of its index.

#include "base/arrays.hpp"

#include <string>
#include <vector>

namespace asterflow::bench {

std::vector<std::string> distributions();

// "uniform" cube of side 1; unit "sphere"; "aster": 1000 radial fibers from a sphere of 5 um to the ellipsoid
// of semi-axes 25, 15, 15 um; "line"; "clusters": two unit cubes 1e4 apart.
PointArray points(std::string const& distribution, long n);

// Components in -0.5 ... 0.5, independent of the points.
PointArray strengths(long n);
PointArray normals(long n);

}  // namespace asterflow::bench
