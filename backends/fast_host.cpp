// The parts of a fast sum on host threads, with the inner loops of one instruction set.

#include "backends/backend.hpp"
#include "backends/fast_far.hpp"
#include "backends/fast_instructions.hpp"
#include "backends/fast_kernel.hpp"
#include "backends/fast_near.hpp"
#include "backends/fast_parts.hpp"
#include "backends/workspace.hpp"
#include "base/parallel.hpp"

#include <algorithm>

namespace asterflow {
namespace {

template <class Real>
class HostParts final : public FastParts {
 public:
  HostParts(std::string_view kernel, FastParameters const& parameters, FastInstructions instructions)
      : near_(near_field(kernel, parameters, fast_loops_of<Real>(instructions))),
        far_(fast_kernel(kernel), fast_loops_of<Real>(instructions), parameters) {}

  void set_points(Octree& tree, ConstPoints normals) override {
    near_.set_points(tree);
    far_.set_points(tree);
    normals_ = tree.sorted(normals);
    work_.grow(std::max(near_.n_work(), far_.n_work()));
  }

  void add(ConstPoints strengths, Points velocity, Points slopes) override {
    Vec3d const* const normals = normals_.empty() ? nullptr : normals_.data();
    Vec3d* const gradient = slopes.empty() ? nullptr : slopes.data();
    near_.set_strengths(strengths.data(), normals);
    parallel_for("Fast::near", near_.n_items(), [&](long i) { near_.add(i, velocity.data(), gradient, work_.data()); });
    parallel_for("Fast::reactions", near_.n_items(), [&](long i) { near_.add_reactions(i, velocity.data(), work_.data()); });
    far_.add(strengths.data(), normals, velocity.data(), gradient, work_.data());
  }

  std::size_t memory() const override {
    return near_.memory() + far_.memory() + sizeof(Real) * work_.capacity() + sizeof(Vec3d) * normals_.capacity();
  }

 private:
  static NearField<Real> near_field(std::string_view kernel, FastParameters const& p, FastLoops<Real> const& loops) {
    KernelSplit const split(p.split_shape);
    NearPolynomials const& compiled = loops.near_polynomials;
    bool const has_outer = compiled.has_outer && !p.gradient;
    return {fast_kernel(kernel), loops, split.local_part(kernel, p.local_tolerance, compiled.pieces),
            has_outer ? split.outer_part(kernel, p.local_tolerance, OuterLevel::pieces, OuterLevel::most) : OuterPart{},
            p.refinement_steps, p.gradient};
  }

  NearField<Real> near_;
  FarField<Real> far_;
  PointArray normals_;
  Workspace<Real> work_;  // of the near field, then of the far field
};

}  // namespace

std::unique_ptr<FastParts> make_host_parts(std::string_view kernel, FastParameters const& parameters,
                                           FastInstructions instructions) {
  if (parameters.single) return std::make_unique<HostParts<float>>(kernel, parameters, instructions);
  return std::make_unique<HostParts<double>>(kernel, parameters, instructions);
}

}  // namespace asterflow
