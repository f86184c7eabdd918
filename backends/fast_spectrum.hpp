#pragma once
// Tables of multipliers of the Fourier modes of a patch.

#include "backends/fast_patch.hpp"

#include <functional>

namespace asterflow {

// Table of filter(k) / (k^4 n_x n_y n_z) times the corrections for the two uses of the grid window, for wave
// numbers k below `band`; all lengths in units of the grid spacing. Rows of `lanes` numbers.
template <class Real>
SymbolTable<Real> make_symbol(int const (&nodes)[3], double band, int lanes, std::function<double(double)> const& filter,
                              std::function<double(double)> const& correction);

extern template SymbolTable<float> make_symbol(int const (&)[3], double, int, std::function<double(double)> const&,
                                               std::function<double(double)> const&);
extern template SymbolTable<double> make_symbol(int const (&)[3], double, int, std::function<double(double)> const&,
                                                std::function<double(double)> const&);

}  // namespace asterflow
