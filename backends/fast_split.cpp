#include "backends/fast_split.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

namespace asterflow {
namespace {

constexpr int n_quadrature = 36;
constexpr int n_fit = 44;

struct Quadrature {
  std::array<double, n_quadrature> x, w;  // Gauss-Legendre on [0, 1]
};

// Roots of the Legendre polynomial by Newton's method.
Quadrature gauss_legendre() {
  Quadrature q;
  for (int i = 0; i < n_quadrature; ++i) {
    double x = std::cos(M_PI * (i + 0.75) / (n_quadrature + 0.5)), slope = 1.0;
    for (int step = 0; step < 50; ++step) {
      double p0 = 1.0, p1 = x;
      for (int n = 2; n <= n_quadrature; ++n) {
        double const p2 = ((2 * n - 1) * x * p1 - (n - 1) * p0) / n;
        p0 = p1;
        p1 = p2;
      }
      slope = n_quadrature * (x * p1 - p0) / (x * x - 1.0);
      double const change = p1 / slope;
      x -= change;
      if (std::abs(change) < 1e-16) break;
    }
    q.x[i] = 0.5 * (1.0 + x);
    q.w[i] = 1.0 / ((1.0 - x * x) * slope * slope);
  }
  return q;
}

using Function = std::function<double(double)>;

// Of the multiples of pi / 2 n.
template <int n>
std::array<double, 4 * n> const& cosines() {
  static auto const table = [] {
    std::array<double, 4 * n> all;
    for (int i = 0; i < 4 * n; ++i) all[i] = std::cos(0.5 * M_PI * i / n);
    return all;
  }();
  return table;
}

// n Chebyshev coefficients in u of f(r) for r^2 between low and high, u = -1 ... 1.
template <int n, class F>
std::vector<double> chebyshev_series(F const& f, double low, double high) {
  std::vector<double> value(n), series(n);
  auto const& cosine = cosines<n>();
  for (int i = 0; i < n; ++i) value[i] = f(low + (high - low) * (0.5 + 0.5 * cosine[2 * i + 1]));
  for (int k = 0; k < n; ++k) {
    double sum = 0.0;
    for (int i = 0; i < n; ++i) sum += value[i] * cosine[k * (2 * i + 1) % (4 * n)];
    series[k] = (k == 0 ? 1.0 : 2.0) * sum / n;
  }
  return series;
}

double largest(std::vector<double> const& series) {
  double a = 0.0;
  for (double s : series) a = std::max(a, std::abs(s));
  return a;
}

int terms_needed(std::vector<double> const& series, double tolerance) {
  double tail = 0.0;
  int n = static_cast<int>(series.size());
  while (n > 1 && (tail += std::abs(series[n - 1])) < tolerance) --n;
  return n;
}

// The series at u, by Clenshaw's recurrence.
double value_at(std::vector<double> const& series, double u) {
  double now = 0.0, after = 0.0;
  for (std::size_t k = series.size() - 1; k > 0; --k) after = std::exchange(now, 2.0 * u * now - after + series[k]);
  return u * now - after + series[0];
}

// Coefficients of x^0, x^1, ... for x = u / 2 of the Chebyshev series cut after n terms, by T_k = 2 u T_{k-1} - T_{k-2}.
std::vector<double> monomials(std::vector<double> const& series, int n) {
  std::vector<double> before(n, 0.0), now(n, 0.0), next(n, 0.0), sum(n, 0.0);
  now[0] = 1.0;
  for (int k = 0; k < n; ++k) {
    for (int i = 0; i < n; ++i) sum[i] += series[k] * now[i];
    for (int i = 0; i < n; ++i) next[i] = (k == 0 ? 1.0 : 2.0) * (i > 0 ? now[i - 1] : 0.0) - (k == 0 ? 0.0 : before[i]);
    before = now;
    now = next;
  }
  for (int i = 0; i < n; ++i) sum[i] = std::ldexp(sum[i], i);
  return sum;
}

// A function of r in [begin, 1] on equal parts of r^2.
class Piecewise {
 public:
  Piecewise(Function const& f, int pieces, double tolerance, double begin = 0.0) {
    auto whole = chebyshev_series<n_fit>([&](double s) { return f(std::sqrt(s)); }, begin * begin, 1.0);
    tolerance = std::max(tolerance, 1e-13 * largest(whole));  // rounding of the coefficients
    if (pieces > 1) whole.resize(terms_needed(whole, 1e-16 * largest(whole)));
    for (int i = 0; i < pieces; ++i) {
      double const low = static_cast<double>(i) / pieces, high = (i + 1.0) / pieces;
      series_.push_back(pieces == 1 ? whole : chebyshev_series<n_fit / 2>([&](double s) { return value_at(whole, 2.0 * s - 1.0); }, low, high));
      terms_ = std::max(terms_, terms_needed(series_.back(), tolerance));
    }
  }
  int terms() const { return terms_; }
  // [term, piece]
  std::vector<double> coefficients(int terms) const {
    std::vector<double> all(terms * series_.size());
    for (std::size_t i = 0; i < series_.size(); ++i) {
      auto const piece = monomials(series_[i], terms);
      for (int k = 0; k < terms; ++k) all[k * series_.size() + i] = piece[k];
    }
    return all;
  }

 private:
  std::vector<std::vector<double>> series_;
  int terms_ = 1;
};

}  // namespace

template <class F>
double KernelSplit::moment(int power, double r, F const& f) {
  static Quadrature const rule = gauss_legendre();
  double sum = 0.0;
  for (int i = 0; i < n_quadrature; ++i) {
    double weight = rule.w[i];
    for (int k = 0; k < power; ++k) weight *= rule.x[i];
    sum += weight * f(r * rule.x[i]);
  }
  return sum;
}

// The polynomials A and B, and what else LocalPart and OuterPart tell of a kernel.
struct KernelSplit::Functions {
  Function a = [](double) { return 0.0; }, b = a;
  double by_first = 1.0, by_second = 1.0;
  int first_power = 0, second_power = 3;  // of 1 / r in the local part before A and B; 0: nothing
  int first_tensor = 0, second_tensor = 2;  // powers of r that it multiplies
  double size = 1.0;  // of the kernel at the cutoff

  double first(double r) const { return by_first * ((first_power > 0 ? std::pow(r, -first_power) : 0.0) - a(r)); }
  double second(double r) const { return by_second * (std::pow(r, -second_power) - b(r)); }
  double local_size(double r) const {
    return (std::abs(first(r)) * std::pow(r, first_tensor) + std::abs(second(r)) * std::pow(r, second_tensor)) / size;
  }
};

KernelSplit::Functions KernelSplit::functions(std::string_view kernel) const {
  auto const g = [this](double x) { return window_.value(x); };
  auto const h = [this](double x) { return window_.slope(x); };
  auto const h2 = [this](double x) { return window_.slope_of_slope(x); };
  auto const third = [=](double r) { return -h(r) - 2.0 * moment(2, r, h); };
  Functions f;
  if (kernel == "stokeslet") {
    f.a = [=](double r) { return 2.0 * g(r) + 2.0 * moment(0, r, g); };
    f.b = [=](double r) { return -2.0 * moment(2, r, h); };
    f.first_power = 1;
  } else if (kernel == "rotlet" || kernel == "stokeslet_pressure") {
    f.b = third;
    f.second_tensor = 1;
    f.by_second = f.size = kernel == "rotlet" ? 1.0 : 2.0;
  } else if (kernel == "stresslet_pressure") {
    f.a = third;
    f.b = [=](double r) { return (h2(r) + 2.0 * moment(4, r, h2)) / 3.0; };
    f.first_power = 3, f.second_power = 5;
    f.by_first = 4.0, f.by_second = -12.0, f.size = 12.0;
  } else {
    f.a = [=](double r) { return 2.0 * h(r); };
    f.b = [=](double r) { return (2.0 / 3.0) * moment(4, r, h2); };
    f.second_power = 5, f.first_tensor = 1, f.second_tensor = 3;
    f.by_second = -6.0, f.size = 6.0;
  }
  return f;
}

LocalPart KernelSplit::local_part(std::string_view kernel, double tolerance, int pieces) const {
  Functions const f = functions(kernel);
  Piecewise const part_a(f.a, pieces, tolerance), part_b(f.b, pieces, tolerance);
  int const n = std::max(part_a.terms(), part_b.terms());
  return {pieces, n, part_a.coefficients(n), part_b.coefficients(n)};
}

// As near as the root mean square of what float rounds of it, over all distances up to the cutoff, is within some part of the tolerance.
OuterPart KernelSplit::outer_part(std::string_view kernel, double tolerance, int pieces, int most_terms) const {
  constexpr double step = 1.0 / 64.0, nearest = 0.4, farthest = 0.95;
  constexpr double rounding = 3e-8;  // of r
  constexpr double part = 0.5;
  Functions const f = functions(kernel);
  double begin = 1.0, squares = 0.0, size = f.local_size(1.0);
  for (double r = 1.0 - step; r >= nearest; r -= step) {
    double const error = rounding * (f.local_size(r) - size) / step;
    size = f.local_size(r);
    squares += 3.0 * r * r * step * error * error;
    if (std::sqrt(squares) > part * tolerance) break;
    begin = r;
  }
  for (; begin <= farthest; begin += step) {
    double const to_pieces = std::round(16.0 * pieces / (1.0 - begin * begin)) / 16.0;
    begin = std::sqrt(1.0 - pieces / to_pieces);
    Piecewise const first([&](double r) { return f.first(r); }, pieces, part * tolerance * f.size, begin);
    Piecewise const second([&](double r) { return f.second(r); }, pieces, part * tolerance * f.size, begin);
    int const n = std::max(first.terms(), second.terms());
    if (n <= most_terms) return {begin, to_pieces, pieces, n, first.coefficients(n), second.coefficients(n)};
  }
  return {};
}

}  // namespace asterflow
