// The oracle: two plain loops in double precision, one target at a time.

#include "backends/backend.hpp"
#include "backends/point_cloud.hpp"
#include "base/error.hpp"
#include "base/parallel.hpp"
#include "kernels/dual.hpp"
#include "kernels/list.hpp"

namespace asterflow {
namespace {

template <PairKernel Kernel>
class Reference final : public Evaluator {
 public:
  void set_points(ConstPoints sources, ConstPoints targets, ConstPoints normals) override {
    ASTERFLOW_REQUIRE(normals.size() == (Kernel::has_normal ? sources.size() : 0));
    bounding_box(sources, targets);  // refuses what is not a number
    sources_.assign(sources.begin(), sources.end());
    targets_.assign(targets.begin(), targets.end());
    normals_.assign(normals.begin(), normals.end());
  }

  void add_velocity(ConstPoints strengths, Points velocity) override {
    ASTERFLOW_REQUIRE(strengths.size() == sources_.size() && velocity.size() == targets_.size());
    parallel_for("Reference::add_velocity", static_cast<long>(targets_.size()), [&](long i) {
      Vec3d total{}, u{};  // partial sums keep rounding errors from growing with the number of sources
      for (std::size_t j = 0; j < sources_.size(); ++j) {
        u += Kernel::velocity(targets_[i] - sources_[j], strengths[j], Kernel::has_normal ? normals_[j] : Vec3d{});
        if (j % 128 != 127) continue;
        total += u;
        u = {};
      }
      velocity[i] += total + u;
    });
  }

  void add_gradient(ConstPoints strengths, Points gradient) override {
    using D = Dual<double>;
    ASTERFLOW_REQUIRE(strengths.size() == sources_.size() && gradient.size() == 3 * targets_.size());
    parallel_for("Reference::add_gradient", static_cast<long>(targets_.size()), [&](long i) {
      for (std::size_t j = 0; j < sources_.size(); ++j) {
        Vec3d const r = targets_[i] - sources_[j], q = strengths[j], n = Kernel::has_normal ? normals_[j] : Vec3d{};
        Vec3<D> const u = Kernel::template shape<D>(differentiable(r), differentiable_inverse(r, inverse_distance(r)),
                                                    {q.x, q.y, q.z}, {n.x, n.y, n.z});
        for (int d = 0; d < 3; ++d)
          gradient[3 * i + d] += Kernel::prefactor * Vec3d{u[d].slope[0], u[d].slope[1], u[d].slope[2]};
      }
    });
  }

  std::string_view backend() const override { return "reference"; }
  std::size_t memory() const override {
    return sizeof(Vec3d) * (sources_.size() + targets_.size() + normals_.size());
  }

 private:
  PointArray sources_, targets_, normals_;
};

}  // namespace

std::unique_ptr<Evaluator> make_reference(std::string_view kernel, EvaluatorOptions const&) {
  std::unique_ptr<Evaluator> evaluator;
  with_kernel(kernel, [&](auto k) { evaluator = std::make_unique<Reference<decltype(k)>>(); });
  return evaluator;
}

}  // namespace asterflow
