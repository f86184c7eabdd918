#pragma once
// Real Fourier transforms along the azimuth (FFTW). A transform may be used by several threads at once.
//   f(phi_k) = Re [ c_0 + 2 sum_{m > 0} c_m e^{i m phi_k} ],  phi_k = 2 pi k / n

#include <complex>
#include <memory>

namespace asterflow {

class AzimuthTransform {
 public:
  explicit AzimuthTransform(int n);  // n values
  ~AzimuthTransform();

  int size() const { return n_; }
  void analyse(double const* values, std::complex<double>* coefficients) const;  // n -> n / 2 + 1
  void synthesise(std::complex<double>* coefficients, double* values) const;     // n / 2 + 1 -> n; destroys its input

 private:
  struct Plans;
  int n_;
  std::unique_ptr<Plans> plans_;
};

}  // namespace asterflow
