#include "backends/rates.hpp"

#include "backends/backend.hpp"
#include "backends/default_space.hpp"
#include "backends/fast_kernel.hpp"
#include "backends/fast_plan.hpp"
#include "backends/rates_file.hpp"
#include "base/cpu_time.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"
#include "base/timer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace asterflow {
namespace {

// At these digits, linear between (direct sums are in float up to six). A pressure is taken for as dear as its flow.
constexpr std::array knots{3.0, 6.0, 7.0, 12.0};
struct KernelRates {
  std::string_view kernel;
  std::array<double, 4> pair, plan;
};
constexpr std::array built_in{
    KernelRates{"stokeslet", {0.254, 0.292, 0.555, 0.567}, {0.814, 0.877, 0.853, 1.03}},
    KernelRates{"stresslet", {0.292, 0.332, 0.615, 0.64}, {0.859, 0.911, 0.89, 1.09}},
    KernelRates{"rotlet", {0.238, 0.28, 0.533, 0.539}, {0.763, 0.797, 0.742, 0.98}}};

// Near the number where both sums cost the same, or enough of them to occupy a device.
constexpr long n_direct = default_space_is_host ? 3000 : 60000, n_fast = default_space_is_host ? 9000 : 200000;

constexpr double enough = 0.2, most = 0.8;  // seconds of repetitions, of which the best count
constexpr int fewest = 3;
constexpr double agreement = 1.2;  // of the best and the median, or other work disturbs them all

// Either way, of a pair over a plan on a host against the table. Threads beside others that take their cores wait for each other,
// steadily, up to 40 times as long as they sum.
constexpr double plausible = 3.0;

Vec3d random_vector(long i, int stream) {
  auto const number = [&](int c) { return uniform_random(5, i, stream, c) - 0.5; };
  return {number(0), number(1), number(2)};
}

PointArray uniform(long n) {
  PointArray x(n);
  for (long i = 0; i < n; ++i) x[i] = random_vector(i, 0);
  return x;
}

// Points on 200 radial lines of lengths 0.4 to 1 that begin 0.4 from the centre.
PointArray aster(long n) {
  constexpr long n_line = 200;
  PointArray x(n);
  for (long i = 0; i < n; ++i) {
    double const length = 0.4 + 0.6 * uniform_random(5, i % n_line, 3, 0);
    double const place = static_cast<double>(i / n_line * n_line) / static_cast<double>(n);
    x[i] = (0.4 + length * place) * normalized(random_vector(i % n_line, 4));
  }
  return x;
}

// A sum over one cloud, to be repeated.
class Trial {
 public:
  Trial(std::unique_ptr<Evaluator> evaluator, PointArray points, bool has_normals)
      : evaluator_(std::move(evaluator)), points_(std::move(points)), strengths_(points_.size()), velocity_(points_.size()) {
    PointArray normals(has_normals ? points_.size() : 0);
    for (std::size_t i = 0; i < points_.size(); ++i) strengths_[i] = random_vector(static_cast<long>(i), 1);
    for (std::size_t i = 0; i < normals.size(); ++i) normals[i] = normalized(random_vector(static_cast<long>(i), 2));
    evaluator_->set_points(points_, points_, normals);
    evaluator_->add_velocity(strengths_, velocity_);  // takes its memory
  }

  // Wall seconds. For the rates of one thread those that other programs took do not count; the processor time of several threads
  // is known to a tick of the system only.
  double repeat() {
    Timer const timer;
    double const before = cpu_seconds();
    evaluator_->add_velocity(strengths_, velocity_);
    double const took = timer.seconds();
    double const seconds = default_space_is_host && thread_count() == 1 ? cpu_seconds() - before : took;
    seconds_.insert(std::upper_bound(seconds_.begin(), seconds_.end(), seconds), seconds);
    return took;
  }
  bool repeats() const { return seconds_[seconds_.size() / 2] < agreement * seconds_.front(); }
  double nanoseconds() const { return 1e9 * seconds_.front(); }
  ConstPoints points() const { return points_; }

 private:
  std::unique_ptr<Evaluator> evaluator_;
  PointArray points_, strengths_, velocity_;
  std::vector<double> seconds_;  // of the repetitions, in order of size
};

double plan_cost(std::string_view kernel, double accuracy, ConstPoints points) {
  return best_plan(kernel, points, points, fast_parameters(kernel, accuracy)).cost;
}

}  // namespace

double predicted_fast(double plan_cost, double n) {
  constexpr double point = 150.0;  // ns: sorting and checking
  return plan_cost + point * n;
}

bool are_plausible(SumRates const& rates, SumRates const& expected) {
  double const ratio = rates.pair / rates.plan / (expected.pair / expected.plan);
  return ratio < plausible && 1.0 / ratio < plausible;
}

SumRates built_in_rates(std::string_view kernel, double accuracy) {
  double const digits = std::clamp(-std::log10(accuracy), knots.front(), knots.back());
  int const i = digits < knots[1] ? 0 : digits < knots[2] ? 1 : 2;
  double const place = (digits - knots[i]) / (knots[i + 1] - knots[i]);
  auto const at = [&](std::array<double, 4> const& row) { return row[i] + place * (row[i + 1] - row[i]); };
  for (KernelRates const& rates : built_in)
    if (kernel.starts_with(rates.kernel)) return {at(rates.pair), at(rates.plan)};
  return {at(built_in[0].pair), at(built_in[0].plan)};
}

// Direct and fast sums in turn, so that what else the machine does meets all alike.
SumRates measured_rates(std::string_view kernel, double accuracy) {
  bool const has_normals = has_normal(fast_kernel(kernel));
  EvaluatorOptions const options{.accuracy = accuracy};
  Trial direct(make_direct(kernel, options), uniform(n_direct), has_normals);
  std::array<Trial, 2> fast{Trial(make_fast(kernel, options), uniform(n_fast), has_normals),
                            Trial(make_fast(kernel, options), aster(n_fast), has_normals)};
  auto const all_repeat = [&] { return direct.repeats() && fast[0].repeats() && fast[1].repeats(); };
  double spent = 0.0;
  for (int i = 0; i < fewest || spent < enough || (spent < most && !all_repeat()); ++i) {
    spent += direct.repeat();
    for (Trial& trial : fast) spent += trial.repeat();
  }
  if (!all_repeat()) return built_in_rates(kernel, accuracy);
  double plan = 1.0;
  for (Trial const& trial : fast)
    plan *= trial.nanoseconds() / predicted_fast(plan_cost(kernel, accuracy, trial.points()), static_cast<double>(n_fast));
  SumRates const rates{direct.nanoseconds() / (static_cast<double>(n_direct) * n_direct), std::sqrt(plan)};
  return default_space_is_host && !are_plausible(rates, built_in_rates(kernel, accuracy)) ? built_in_rates(kernel, accuracy) : rates;
}

SumRates sum_rates(std::string_view kernel, double accuracy) {
  int const digits = std::clamp(static_cast<int>(std::lround(-std::log10(accuracy))), 3, 12);
  std::string const key = rates_key(kernel, digits);
  if (auto const stored = read_rates(key)) return *stored;
  if (!can_store_rates()) return built_in_rates(kernel, accuracy);
  write_rates(key, measured_rates(kernel, std::pow(10.0, -digits)));
  return read_rates(key).value_or(built_in_rates(kernel, accuracy));
}

}  // namespace asterflow
