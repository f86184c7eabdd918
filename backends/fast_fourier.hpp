#pragma once
// Plans of one-dimensional complex Fourier transforms, run by the loops of fast_fourier.inl. Lengths are products
// of 2, 3, 4 and 5.

#include "backends/fast_loops.hpp"

#include <vector>

namespace asterflow {

// The smallest even length >= n that is a product of 2, 3 and 5.
int transform_length(int n);

template <class Real>
class LineTransform {
 public:
  explicit LineTransform(int n);

  LineView<Real> view() const {
    return {n_, static_cast<int>(radices_.size()), radices_.data(), twiddles_.data()};
  }

 private:
  int n_;
  std::vector<int> radices_;
  std::vector<Real> twiddles_;  // of all stages: cos, sin of 2 pi j p / n for j = 1 .. radix - 1, p = 0 .. n / radix - 1
};

extern template class LineTransform<float>;
extern template class LineTransform<double>;

}  // namespace asterflow
