#include "surface/azimuth_transform.hpp"

#include <fftw3.h>
#include <mutex>
#include <vector>

namespace asterflow {
namespace {

std::mutex& planner_guard() {  // FFTW plans one transform at a time
  static std::mutex guard;
  return guard;
}

fftw_complex* as_fftw(std::complex<double>* c) { return reinterpret_cast<fftw_complex*>(c); }

}  // namespace

struct AzimuthTransform::Plans {
  fftw_plan forward, backward;
};

AzimuthTransform::AzimuthTransform(int n) : n_(n), plans_(std::make_unique<Plans>()) {
  std::scoped_lock lock(planner_guard());
  std::vector<double> values(n);
  std::vector<std::complex<double>> coefficients(n / 2 + 1);
  unsigned const flags = FFTW_ESTIMATE | FFTW_UNALIGNED;
  plans_->forward = fftw_plan_dft_r2c_1d(n, values.data(), as_fftw(coefficients.data()), flags | FFTW_PRESERVE_INPUT);
  plans_->backward = fftw_plan_dft_c2r_1d(n, as_fftw(coefficients.data()), values.data(), flags | FFTW_DESTROY_INPUT);
}

AzimuthTransform::~AzimuthTransform() {
  std::scoped_lock lock(planner_guard());
  fftw_destroy_plan(plans_->forward);
  fftw_destroy_plan(plans_->backward);
}

void AzimuthTransform::analyse(double const* values, std::complex<double>* coefficients) const {
  fftw_execute_dft_r2c(plans_->forward, const_cast<double*>(values), as_fftw(coefficients));
  for (int m = 0; m <= n_ / 2; ++m) coefficients[m] /= n_;
}

void AzimuthTransform::synthesise(std::complex<double>* coefficients, double* values) const {
  fftw_execute_dft_c2r(plans_->backward, as_fftw(coefficients), values);
}

}  // namespace asterflow
