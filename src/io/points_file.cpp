#include "io/points_file.hpp"

#include "base/error.hpp"
#include "io/array_file.hpp"
#include "io/whole_file.hpp"

#include <cmath>
#include <filesystem>
#include <fmt/format.h>

namespace asterflow {

namespace {

PointArray read_finite(ArrayFile const& file, std::string const& path, std::string const& name) {
  PointArray points = file.read_points(name);
  for (std::size_t i = 0; i < points.size(); ++i)
    for (int k = 0; k < 3; ++k)
      if (!std::isfinite(points[i][k]))
        throw SceneError(fmt::format("{}: dataset \"{}\": row {} holds {}: every number must be finite", path, name, i,
                                     points[i][k]));
  return points;
}

void check_count(std::string const& path, std::string const& name, std::size_t n, std::size_t n_source) {
  if (n != n_source)
    throw SceneError(fmt::format("{}: dataset \"{}\": has {} rows, must have one for each of the {} sources", path,
                                 name, n, n_source));
}

}  // namespace

PointsFile read_points_file(std::string const& path, bool needs_normals) {
  ArrayFile const file(path, ArrayFile::Mode::read);
  PointsFile points;
  points.sources = read_finite(file, path, "sources");
  points.strengths = read_finite(file, path, "strengths");
  check_count(path, "strengths", points.strengths.size(), points.sources.size());
  if (needs_normals) {
    points.normals = read_finite(file, path, "normals");
    check_count(path, "normals", points.normals.size(), points.sources.size());
  }
  points.targets = file.has("targets") ? read_finite(file, path, "targets") : points.sources;
  return points;
}

void write_sums(std::string const& path, ConstPoints velocity, ConstPoints gradient, std::vector<double> const& pressure) {
  write_whole(path, [&](std::filesystem::path const& part) {
    ArrayFile file(part, ArrayFile::Mode::create);
    file.write(NamedArray::of("velocity", velocity, "um/s"));
    if (!gradient.empty()) {
      NamedArray array = NamedArray::of("gradient", gradient, "1/s");
      array.shape = {gradient.size() / 3, 3, 3};
      file.write(array);
    }
    if (!pressure.empty()) file.write(NamedArray::of("pressure", pressure, "Pa"));
    file.close();
  });
}

}  // namespace asterflow
