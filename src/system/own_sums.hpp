#pragma once
// What a sum of Stokeslets over the nodes of all fibers holds of each fiber's flow at its own nodes. That flow is the fiber's
// local drag (fiber/fiber_response.hpp) and is taken out of the sum.

#include "base/arrays.hpp"

#include <cstddef>
#include <vector>

namespace asterflow {

// velocity [n] (um/s) -= sum over the other nodes of the same fiber; strengths [n] in pN over viscosity.
// Fiber i owns the nodes [first[i], first[i + 1]) at `positions` [n] (um). Real: double or float.
template <class Real>
void subtract_own_sums(ConstPoints positions, std::vector<std::size_t> const& first, ConstPoints strengths, Points velocity);

}  // namespace asterflow
