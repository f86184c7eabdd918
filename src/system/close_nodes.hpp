#pragma once
// Nodes of different fibers closer to each other than their spacing can resolve. Points of force whose weights w stand for
// pieces of line must not come closer than about w / 8: there the flow of one at the other, w f / (8 pi mu r), exceeds the
// fiber's own mobility, 12 f / (8 pi mu), and forces grow without bound, although two lines that cross at the distance r
// only feel 2 log(w / r) f / (8 pi mu). Below delta = (w_i + w_j) / 8 the Stokeslet (I + r r / r^2) / r is therefore replaced by
//   (a(r / delta) I + b(r / delta) r r / r^2) / delta,   a(x) = (3 - x^2) / 2,  b(x) = (5 x^2 - 3 x^4) / 2,
// which joins it with its first derivative and is 3 I / (2 delta) at r = 0: fibers may cross.

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
