#pragma once
// The Kaiser-Bessel window, used twice by the fast summation: to split a kernel into a smooth and a
// local part, and to spread point strengths onto a grid. It is even, lives on [-1, 1] and its spectrum
// falls to about exp(-shape) at wave number `shape` [Kaiser 1966; Barnett, Magland & af Klinteberg 2019]:
//   g(x) = I0(c sqrt(1 - x^2)) c / (2 sinh c),   integral 1
//   spectrum(k) = integral of g(x) cos(k x) dx = (c / sinh c) sinh(sqrt(c^2 - k^2)) / sqrt(c^2 - k^2)

namespace asterflow {

class KaiserBessel {
 public:
  explicit KaiserBessel(double shape);

  double value(double x) const;           // g(x), |x| <= 1
  double slope(double x) const;           // h = g'(x) / x, smooth at 0
  double slope_of_slope(double x) const;  // h'(x) / x, smooth at 0
  double spectrum(double k) const;
  double spectrum_slope(double k) const;  // d spectrum / dk

 private:
  double shape_;
  double scale_;  // c / (2 sinh c)
};

}  // namespace asterflow
