#pragma once
// Nodes of different fibers closer to each other than their spacing can resolve. A point of force whose weight w stands for a
// piece of line must not act as a point there: the flow of one at the other, w f / (8 pi mu r), would exceed the fiber's own
// mobility, 12 f / (8 pi mu), and bundles would move against the forces on them, although two lines at the distance r only
// feel 2 log(w / r) f / (8 pi mu). A node acts and feels as a sphere of radius a = 0.3 w instead: between nodes with a and b,
//   r < a + b   mean flow over one sphere of a force spread over the other [Rotne & Prager 1969; Zuk et al. 2014, Eq. 3.7]:
//               no forces move against themselves; 4 / (3 max(a, b)) I at r = 0, so fibers may cross
//   beyond      ((1 + q / 3) I + (1 - q) r r / r^2) / r, q = (a^2 + b^2) / r^2, fading to the Stokeslet at 1.25 (a + b)

#include "base/arrays.hpp"

#include <cstddef>
#include <vector>

namespace asterflow {

class CloseNodes {
 public:
  // Fiber i owns the nodes [first[i], first[i + 1]) at `positions` [n] (um), with `weights` [n] (um).
  void find(ConstPoints positions, ConstVector weights, std::vector<std::size_t> const& first);

  // velocity [n] (um/s) += what the replacement changes; strengths [n] in pN over viscosity.
  void add_correction(ConstPoints strengths, Points velocity) const;

  std::size_t count() const;  // of ordered pairs

 private:
  struct Pair {
    std::size_t target, source;
    Vec3d r;           // um, from source to target
    double one, outer;  // factors of I and r r, over 8 pi
  };
  std::vector<std::vector<Pair>> blocks_;  // by target
};

}  // namespace asterflow
