// What is stored of fibers, and how it comes back.
//   fiber/length [n_fiber] um, fiber/minus_end [n_fiber, 3] um, fiber/tangent [n_tangent_total, 3]: the shapes
//   fiber/tension [n_node_total] pN, positive where stretched
//   fiber/ends [n_fiber, 9] pN, pN, pN um: forces at the ends; fiber/load [n_fiber, 4] pN/um
//   fiber/history/...: the same of the two accepted states before, how many of them count, and their time steps
//   fiber/site/...: what holds the minus ends

#include "base/stored_values.hpp"
#include "fiber/fibers.hpp"

#include <algorithm>

namespace asterflow {

namespace {

constexpr char const* prefixes[3] = {"fiber/", "fiber/history/before_", "fiber/history/before_that_"};

Vec3d point(std::vector<double> const& values, std::size_t i) {
  return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
}

}  // namespace

NamedArray Fibers::stored_ends() const {
  std::vector<double> values;
  for (Fiber const& fiber : fibers_)
    for (Vec3d v : {fiber.ends.plus_end, fiber.ends.minus_end, fiber.ends.minus_end_torque})
      values.insert(values.end(), {v.x, v.y, v.z});
  return {"fiber/ends", {count(), 9}, values, ""};
}

NamedArray Fibers::stored_loads() const {
  std::vector<double> values;
  for (Fiber const& fiber : fibers_) {
    Vec3d const f = fiber.load.external;
    values.insert(values.end(), {f.x, f.y, f.z, fiber.load.motor});
  }
  return {"fiber/load", {count(), 4}, values, "pN/um"};
}

NamedArray Fibers::stored_late_forces() const {
  PointArray forces;
  for (Fiber const& fiber : fibers_) forces.push_back(fiber.late_force);
  return NamedArray::of("fiber/late_force", forces, "pN");
}

std::vector<NamedArray> Fibers::state() const {
  std::vector<NamedArray> arrays;
  for (int past = 0; past < 3; ++past) {
    std::vector<double> lengths;
    PointArray minus_ends, tangents;
    for (Fiber const& fiber : fibers_) {
      Centreline const& shape = fiber.past[past];
      lengths.push_back(shape.length);
      minus_ends.push_back(shape.minus_end);
      tangents.insert(tangents.end(), shape.tangents.begin(), shape.tangents.end());
    }
    std::string const prefix = prefixes[past];
    arrays.push_back(NamedArray::of(prefix + "length", std::move(lengths), "um"));
    arrays.push_back(NamedArray::of(prefix + "minus_end", minus_ends, "um"));
    arrays.push_back(NamedArray::of(prefix + "tangent", tangents, ""));
  }
  std::vector<double> tensions;
  for (Fiber const& fiber : fibers_) tensions.insert(tensions.end(), fiber.tension.begin(), fiber.tension.end());
  arrays.push_back(NamedArray::of("fiber/tension", std::move(tensions), "pN"));
  arrays.push_back(stored_ends());
  arrays.push_back(stored_loads());
  arrays.push_back(stored_late_forces());
  std::vector<std::int64_t> counts, smooth, kinds, bodies;
  PointArray positions, directions;
  for (Fiber const& fiber : fibers_) {
    counts.push_back(fiber.n_past);
    smooth.push_back(fiber.n_smooth);
    kinds.push_back(static_cast<std::int64_t>(fiber.site.kind));
    bodies.push_back(fiber.site.body);
    positions.push_back(fiber.site.position);
    directions.push_back(fiber.site.direction);
  }
  arrays.push_back(NamedArray::of("fiber/history/count", std::move(counts)));
  arrays.push_back(NamedArray::of("fiber/history/smooth", std::move(smooth)));
  arrays.push_back(NamedArray::of("fiber/history/time_step", std::vector<double>{dt_1_, dt_2_}, "s"));
  arrays.push_back(NamedArray::of("fiber/site/kind", std::move(kinds)));
  arrays.push_back(NamedArray::of("fiber/site/body", std::move(bodies)));
  arrays.push_back(NamedArray::of("fiber/site/position", positions, "um"));
  arrays.push_back(NamedArray::of("fiber/site/direction", directions, ""));
  return arrays;
}

void Fibers::restore(std::span<NamedArray const> state) {
  std::size_t const n = count();
  std::size_t n_tangent = 0;
  for (Fiber const& fiber : fibers_) n_tangent += fiber.past[0].tangents.size();
  for (int past = 0; past < 3; ++past) {
    std::string const prefix = prefixes[past];
    auto const& lengths = stored_values(state, prefix + "length", n);
    auto const& minus_ends = stored_values(state, prefix + "minus_end", 3 * n);
    auto const& tangents = stored_values(state, prefix + "tangent", 3 * n_tangent);
    std::size_t next = 0;
    for (std::size_t i = 0; i < n; ++i) {
      Centreline& shape = fibers_[i].past[past];
      shape.length = lengths[i];
      shape.minus_end = point(minus_ends, i);
      for (Vec3d& t : shape.tangents) t = point(tangents, next++);
    }
  }
  auto const& tensions = stored_values(state, "fiber/tension", node_count());
  for (std::size_t i = 0; i < n; ++i)
    std::copy_n(tensions.begin() + first_node_[i], fibers_[i].tension.size(), fibers_[i].tension.begin());
  auto const& counts = stored_values<std::int64_t>(state, "fiber/history/count", n);
  auto const& smooth = stored_values<std::int64_t>(state, "fiber/history/smooth", n);
  auto const& time_steps = stored_values(state, "fiber/history/time_step", 2);
  auto const& kinds = stored_values<std::int64_t>(state, "fiber/site/kind", n);
  auto const& bodies = stored_values<std::int64_t>(state, "fiber/site/body", n);
  auto const& positions = stored_values(state, "fiber/site/position", 3 * n);
  auto const& directions = stored_values(state, "fiber/site/direction", 3 * n);
  auto const& ends = stored_values(state, "fiber/ends", 9 * n);
  auto const& loads = stored_values(state, "fiber/load", 4 * n);
  auto const& late_forces = stored_values(state, "fiber/late_force", 3 * n);
  for (std::size_t i = 0; i < n; ++i) {
    fibers_[i].ends = {point(ends, 3 * i), point(ends, 3 * i + 1), point(ends, 3 * i + 2)};
    fibers_[i].load = {{loads[4 * i], loads[4 * i + 1], loads[4 * i + 2]}, loads[4 * i + 3]};
    fibers_[i].late_force = point(late_forces, i);
    fibers_[i].n_past = static_cast<int>(counts[i]);
    fibers_[i].n_smooth = static_cast<int>(smooth[i]);
    fibers_[i].site = {static_cast<MinusEnd>(kinds[i]), static_cast<int>(bodies[i]), point(positions, i),
                       point(directions, i)};
  }
  dt_1_ = time_steps[0];
  dt_2_ = time_steps[1];
}

}  // namespace asterflow
