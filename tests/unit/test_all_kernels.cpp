// What every pair kernel must obey, and what the single ones are.

#include "base/random.hpp"
#include "kernels/list.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <functional>
#include <vector>

using namespace asterflow;

namespace {

using Complex = std::complex<double>;

Vec3d random_vector(std::uint64_t seed) {
  return {2.0 * uniform_random(seed, 0, 0, 0) - 1.0, 2.0 * uniform_random(seed, 0, 0, 1) - 1.0,
          2.0 * uniform_random(seed, 0, 0, 2) - 1.0};
}

// Three columns: a rotation (determinant 1) or a reflection of one (determinant -1).
struct Orthogonal {
  Vec3d a, b, c;
  Vec3d operator*(Vec3d x) const { return x.x * a + x.y * b + x.z * c; }
};

Orthogonal random_orthogonal(std::uint64_t seed, double determinant) {
  Vec3d const a = normalized(random_vector(seed));
  Vec3d const b = normalized(cross(a, random_vector(seed + 1)));
  return {a, b, determinant * cross(a, b)};
}

// d u_i / d r_j by the complex step: no cancellation, so exact to rounding.
template <class Kernel>
double derivative(int i, int j, Vec3d r, Vec3d q, Vec3d n) {
  double const step = 1e-30;
  Vec3<Complex> z{r.x, r.y, r.z};
  z[j] += Complex(0.0, step);
  Vec3<Complex> const u = Kernel::template shape<Complex>(z, Complex(1.0) / std::sqrt(dot(z, z)), {q.x, q.y, q.z},
                                                         {n.x, n.y, n.z});
  return Kernel::prefactor * u[i].imag() / step;
}

template <class Kernel>
Vec3d curl(Vec3d r, Vec3d q) {
  auto const d = [&](int i, int j) { return derivative<Kernel>(i, j, r, q, {}); };
  return {d(2, 1) - d(1, 2), d(0, 2) - d(2, 0), d(1, 0) - d(0, 1)};
}

void expect_near(Vec3d a, Vec3d b, double bound, char const* what) {
  EXPECT_LE(norm(a - b), bound * (norm(a) + norm(b))) << what;
}

// visit(kernel, r, q, n, where) for every kernel at several random places.
template <class Visit>
void for_each_kernel(Visit visit) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Vec3d const r = random_vector(seed), q = random_vector(seed + 100), n = normalized(random_vector(seed + 200));
    std::apply([&](auto... kernel) { (visit(kernel, r, q, n, kernel.name.data()), ...); }, AllKernels{});
  }
}

constexpr double rounding = 1e-14;  // some tens of operations, and no cancellation beyond a factor of ten

// Nodes and weights of Gauss-Legendre quadrature on [-1, 1], by Newton's method.
std::vector<std::pair<double, double>> gauss_legendre(int n) {
  std::vector<std::pair<double, double>> rule;
  for (int i = 0; i < n; ++i) {
    double x = std::cos(M_PI * (i + 0.75) / (n + 0.5)), slope = 0.0;
    for (int iteration = 0; iteration < 100; ++iteration) {
      double p = 1.0, previous = 0.0;
      for (int k = 1; k <= n; ++k) {
        double const next = ((2 * k - 1) * x * p - (k - 1) * previous) / k;
        previous = p;
        p = next;
      }
      slope = n * (x * p - previous) / (x * x - 1.0);
      x -= p / slope;
      if (std::abs(p) < 1e-15) break;
    }
    rule.emplace_back(x, 2.0 / ((1.0 - x * x) * slope * slope));
  }
  return rule;
}

// Double layer with constant density q on the unit sphere, seen from `target` on the positive z axis. Gauss-
// Legendre in the polar angle, so that the area element removes the singularity when the target is the pole.
Vec3d double_layer_of_sphere(Vec3d target, Vec3d q) {
  Vec3d u{};
  int const n_azimuth = 32;
  for (auto const& [x, weight] : gauss_legendre(80)) {
    double const polar = 0.5 * M_PI * (x + 1.0);
    for (int k = 0; k < n_azimuth; ++k) {
      double const azimuth = 2.0 * M_PI * k / n_azimuth;
      Vec3d const normal{std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar)};
      double const area = weight * 0.5 * M_PI * std::sin(polar) * 2.0 * M_PI / n_azimuth;
      u += area * Stresslet::velocity(target - normal, q, normal);
    }
  }
  return u;
}

}  // namespace

TEST(All_kernels, velocity_is_divergence_free) {
  for_each_kernel([](auto kernel, Vec3d r, Vec3d q, Vec3d n, char const* name) {
    using Kernel = decltype(kernel);
    double sum = 0.0, size = 0.0;
    for (int i = 0; i < 3; ++i) {
      sum += derivative<Kernel>(i, i, r, q, n);
      size += std::abs(derivative<Kernel>(i, i, r, q, n));
    }
    EXPECT_LE(std::abs(sum), 10 * rounding * size) << name;
  });
}

TEST(All_kernels, velocity_turns_with_its_arguments_and_reflects_as_vector_or_axial_vector) {
  for_each_kernel([](auto kernel, Vec3d r, Vec3d q, Vec3d n, char const* name) {
    for (double const determinant : {1.0, -1.0}) {
      Orthogonal const m = random_orthogonal(7, determinant);
      bool const is_axial = kernel.parity * (kernel.has_normal ? 1 : -1) == 1;  // what -1 does to r, q and n
      double const sign = is_axial ? determinant : 1.0;
      expect_near(kernel.velocity(m * r, m * q, m * n), sign * (m * kernel.velocity(r, q, n)), rounding, name);
    }
  });
}

TEST(All_kernels, velocity_decays_with_the_stated_power) {
  for_each_kernel([](auto kernel, Vec3d r, Vec3d q, Vec3d n, char const* name) {
    expect_near(kernel.velocity(3.0 * r, q, n), std::pow(3.0, -kernel.decay) * kernel.velocity(r, q, n), rounding, name);
  });
}

TEST(All_kernels, velocity_has_the_stated_parity) {
  for_each_kernel([](auto kernel, Vec3d r, Vec3d q, Vec3d n, char const* name) {
    expect_near(kernel.velocity(-r, q, n), double(kernel.parity) * kernel.velocity(r, q, n), rounding, name);
  });
}

TEST(All_kernels, velocity_is_linear_in_the_strength) {
  for_each_kernel([](auto kernel, Vec3d r, Vec3d q, Vec3d n, char const* name) {
    Vec3d const p = random_vector(5);
    expect_near(kernel.velocity(r, 2.0 * q - p, n), 2.0 * kernel.velocity(r, q, n) - kernel.velocity(r, p, n),
                10 * rounding, name);
  });
}

TEST(All_kernels, velocity_is_zero_at_the_source) {
  for_each_kernel([](auto kernel, Vec3d, Vec3d q, Vec3d n, char const* name) {
    EXPECT_EQ(norm(kernel.velocity(Vec3d{}, q, n)), 0.0) << name;
    EXPECT_EQ(norm(kernel.velocity(Vec3<float>{}, Vec3<float>{1.0f, 2.0f, 3.0f}, Vec3<float>{0.0f, 0.0f, 1.0f})), 0.0f) << name;
  });
}

TEST(All_kernels, shape_times_prefactor_is_the_velocity) {
  for_each_kernel([](auto kernel, Vec3d r, Vec3d q, Vec3d n, char const* name) {
    expect_near(kernel.prefactor * kernel.shape(r, 1.0 / norm(r), q, n), kernel.velocity(r, q, n), rounding, name);
    EXPECT_EQ(norm(kernel.shape(r, 0.0, q, n)), 0.0) << name;
  });
}

TEST(Stokeslet, velocity_along_the_force_is_twice_that_across_it) {
  Vec3d const force{2.0, 0.0, 0.0};
  Vec3d const along = Stokeslet::velocity(Vec3d{3.0, 0.0, 0.0}, force);
  Vec3d const across = Stokeslet::velocity(Vec3d{0.0, 3.0, 0.0}, force);
  EXPECT_DOUBLE_EQ(along.x, 2.0 * across.x);
  EXPECT_DOUBLE_EQ(across.x, 2.0 / (8.0 * M_PI * 3.0));
}

TEST(Stokeslet, obeys_the_reciprocal_theorem) {
  Vec3d const r = random_vector(1), f = random_vector(2), g = random_vector(3);
  EXPECT_NEAR(dot(f, Stokeslet::velocity(r, g)), dot(g, Stokeslet::velocity(r, f)), rounding);
}

TEST(Rotlet, velocity_is_half_the_curl_of_a_stokeslet_of_the_same_strength) {
  Vec3d const r = random_vector(1), t = random_vector(2);
  expect_near(Rotlet::velocity(r, t), 0.5 * curl<Stokeslet>(r, t), rounding, "rotlet");
}

TEST(Rotlet, turns_a_small_sphere_with_the_torque) {
  // On the equator of a sphere of radius a about its axis, u = t / (8 pi a^2): the rotating sphere t = 8 pi a^3 Omega.
  EXPECT_DOUBLE_EQ(Rotlet::velocity(Vec3d{0.5, 0.0, 0.0}, Vec3d{0.0, 0.0, 1.0}).y, 1.0 / (8.0 * M_PI * 0.25));
}

TEST(Stresslet, constant_density_on_a_closed_surface_gives_it_inside_half_on_and_nothing_outside) {
  Vec3d const q{0.3, -0.7, 0.5};
  double const bound = 1e-9;  // quadrature error at a distance of 0.4 radii
  EXPECT_LE(norm(double_layer_of_sphere({0.0, 0.0, 0.6}, q) - q), bound);
  EXPECT_LE(norm(double_layer_of_sphere({0.0, 0.0, 1.0}, q) - 0.5 * q), bound);
  EXPECT_LE(norm(double_layer_of_sphere({0.0, 0.0, 1.4}, q)), bound);
}
