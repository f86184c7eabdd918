#include "backends/fast_fourier.hpp"

#include <cmath>

namespace asterflow {

int transform_length(int n) {
  for (int length = n + n % 2;; length += 2) {
    int rest = length;
    for (int factor : {2, 3, 5})
      while (rest % factor == 0) rest /= factor;
    if (rest == 1) return length;
  }
}

template <class Real>
LineTransform<Real>::LineTransform(int n) : n_(n) {
  for (int rest = n; rest > 1;)
    for (int radix : {4, 2, 3, 5})
      if (rest % radix == 0) {
        radices_.push_back(radix);
        rest /= radix;
        break;
      }
  int m = n;
  for (int radix : radices_) {
    for (int p = 0; p < m / radix; ++p)
      for (int j = 1; j < radix; ++j) {
        double const angle = 2.0 * M_PI * j * p / m;
        twiddles_.push_back(static_cast<Real>(std::cos(angle)));
        twiddles_.push_back(static_cast<Real>(std::sin(angle)));
      }
    m /= radix;
  }
}

template class LineTransform<float>;
template class LineTransform<double>;

}  // namespace asterflow
