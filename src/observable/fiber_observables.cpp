#include "observable/fiber_observables.hpp"

#include "fiber/fiber_ends.hpp"

#include <algorithm>
#include <cmath>

namespace asterflow {
namespace {

// As TipState (fiber/fiber_ends.hpp) numbers them in stored states.
enum Tip : std::int64_t { growing = 1, shrinking = 2, pushing = 3, captured = 4 };

double not_zero(double x) { return x == 0.0 ? std::nan("") : x; }

void add_ends(StoredFibers const& fibers, Observables& row) {
  auto const count = [&](Tip state) {
    return static_cast<double>(std::count(fibers.tip_state.begin(), fibers.tip_state.end(), state));
  };
  double plus = 0.0, minus = 0.0;
  Vec3d net_plus{}, net_minus{};
  for (std::size_t i = 0; i < fibers.count(); ++i) {
    if (fibers.tip_state[i] != pushing && fibers.tip_state[i] != captured) continue;
    plus += norm(fibers.plus_end_force[i]);
    minus += norm(fibers.minus_end_force[i]);
    net_plus += fibers.plus_end_force[i];
    net_minus += fibers.minus_end_force[i];
  }
  row.push_back({"fibers_growing", count(growing)});
  row.push_back({"fibers_shrinking", count(shrinking)});
  row.push_back({"fibers_pushing", count(pushing)});
  row.push_back({"fibers_captured", count(captured)});
  row.push_back({"plus_end_force", plus});
  row.push_back({"minus_end_force", minus});
  row.push_back({"end_force_ratio", minus / not_zero(plus)});
  row.push_back({"net_plus_end_force", norm(net_plus)});
  row.push_back({"net_minus_end_force", norm(net_minus)});
}

void add_lengths(StoredFibers const& fibers, Observables& row) {
  double const n = not_zero(static_cast<double>(fibers.count()));
  double sum = 0.0, squares = 0.0;
  for (double const length : fibers.length) sum += length, squares += length * length;
  auto const [least, largest] = std::minmax_element(fibers.length.begin(), fibers.length.end());
  double const nothing = std::nan("");
  row.push_back({"length_mean", sum / n});
  row.push_back({"length_deviation", std::sqrt(std::max(0.0, squares / n - sum / n * sum / n))});
  row.push_back({"length_least", fibers.count() > 0 ? *least : nothing});
  row.push_back({"length_largest", fibers.count() > 0 ? *largest : nothing});
}

void add_shapes(StoredFibers const& fibers, Observables& row) {
  double bent = 0.0, energy = 0.0, length = 0.0, sharpest = 0.0, tension = 0.0;
  PointArray tangents, curvatures;
  for (std::size_t i = 0; i < fibers.count(); ++i) {
    tangents.resize(fibers.node_count(i)), curvatures.resize(fibers.node_count(i));
    differentiate(fibers, i, tangents, curvatures);
    double own = 0.0;
    for (int k = 0; k < fibers.node_count(i); ++k) {
      std::size_t const node = fibers.first[i] + k;
      double const square = dot(curvatures[k], curvatures[k]);
      own += fibers.weight[node] * square;
      tension += fibers.weight[node] * fibers.tension[node];
      sharpest = std::max(sharpest, square);
    }
    bent += own;
    energy += 0.5 * fibers.material[i].bending_rigidity * own;
    length += fibers.length[i];
  }
  auto const [least, largest] = std::minmax_element(fibers.tension.begin(), fibers.tension.end());
  double const nothing = std::nan("");
  bool const has_fibers = !fibers.tension.empty();
  row.push_back({"curvature_mean", std::sqrt(bent / not_zero(length))});
  row.push_back({"curvature_largest", std::sqrt(sharpest)});
  row.push_back({"tension_mean", tension / not_zero(length)});
  row.push_back({"tension_least", has_fibers ? *least : nothing});
  row.push_back({"tension_largest", has_fibers ? *largest : nothing});
  row.push_back({"elastic_energy", energy});
}

}  // namespace

Observables fiber_observables(StoredFibers const& fibers) {
  Observables row;
  add_ends(fibers, row);
  add_lengths(fibers, row);
  add_shapes(fibers, row);
  return row;
}

std::vector<double> length_distribution(StoredFibers const& fibers, double width, int n_bin) {
  std::vector<double> fractions(n_bin, 0.0);
  for (double const length : fibers.length)
    fractions[std::min(static_cast<int>(length / width), n_bin - 1)] += 1.0 / static_cast<double>(fibers.count());
  return fractions;
}

}  // namespace asterflow
