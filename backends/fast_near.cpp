#include "backends/fast_near.hpp"

#include "backends/blocks.hpp"
#include "backends/fast_kernel.hpp"
#include "base/error.hpp"
#include "kernels/dual.hpp"

#include "backends/fast_near_kernels.inl"

#include <algorithm>
#include <cmath>

namespace asterflow {

template <class Real>
NearField<Real>::NearField(FastKernel kernel, FastLoops<Real> const& loops, LocalPart const& local, OuterPart const& outer,
                           int refinement_steps, bool gradient)
    : kernel_(kernel),
      loops_(loops),
      lists_(loops.lanes, split_coordinates, loops.list_near, outer.begin),
      local_(local),
      outer_(outer),
      refinement_steps_(refinement_steps),
      gradient_(gradient) {
  NearPolynomials const& compiled = loops.near_polynomials;
  int const missing = std::max(0, local_.terms - compiled.fewest);
  local_.terms = compiled.fewest + (missing + compiled.step - 1) / compiled.step * compiled.step;
  ASTERFLOW_REQUIRE(local_.pieces == compiled.pieces && local_.terms <= compiled.most);
  local_.a.resize(local_.terms * local_.pieces, 0.0);
  local_.b.resize(local_.terms * local_.pieces, 0.0);
  if (outer_.terms > 0) {
    ASTERFLOW_REQUIRE(compiled.has_outer && !gradient && outer_.pieces == OuterLevel::pieces && outer_.terms <= OuterLevel::most);
    outer_.terms = std::max(outer_.terms, OuterLevel::fewest);
    outer_.first.resize(outer_.terms * outer_.pieces, 0.0);
    outer_.second.resize(outer_.terms * outer_.pieces, 0.0);
  }
  record_ = (split_coordinates ? 6 : 3) + n_component(kernel);
}

template <class Real>
void NearField<Real>::make_levels() {
  levels_.clear();
  outer_levels_.clear();
  int const power = has_normal(kernel_) ? NearStresslet::powers : NearStokeslet::powers;
  for (int level = 0; level < lists_.n_level(); ++level) {
    double const cutoff = std::ldexp(lists_.side(), -level);
    NearLevel<Real> l{};
    l.cutoff2 = static_cast<Real>((1.0 - 1e-6) * cutoff * cutoff);  // rounding leads to no piece beyond the last
    l.to_pieces = static_cast<Real>(local_.pieces / (cutoff * cutoff));
    for (std::size_t k = 0; k < local_.a.size(); ++k) {
      l.a[k] = static_cast<Real>(local_.a[k] * std::pow(cutoff, -power));
      l.b[k] = static_cast<Real>(local_.b[k] * std::pow(cutoff, -power - 2));
    }
    levels_.push_back(l);
    if (outer_.terms == 0) continue;
    OuterLevel o{};
    o.to_cutoff = 1.0 / cutoff;
    o.to_pieces = static_cast<float>(outer_.to_pieces);
    o.shift = static_cast<float>(outer_.pieces - 0.5 - outer_.to_pieces);
    for (std::size_t k = 0; k < outer_.first.size(); ++k) {
      o.first[k] = static_cast<float>(outer_.first[k] * std::pow(cutoff, -decay(kernel_)));
      o.second[k] = static_cast<float>(outer_.second[k] * std::pow(cutoff, -decay(kernel_)));
    }
    outer_levels_.push_back(o);
  }
}

template <class Real>
void NearField<Real>::set_points(Octree& tree) {
  lists_.set_points(tree, !gradient_);
  velocity_scale_ = std::pow(lists_.side(), decay(kernel_)) / (8.0 * M_PI);
  make_levels();
  copy_coordinates();
}

template <class Real>
void NearField<Real>::copy_coordinates() {
  PointArray const& sources = lists_.sources();
  records_.grow(sources.size() * record_);
  Real* const records = records_.data();
  for_blocks("NearField::copy_coordinates", static_cast<long>(sources.size()), [&](long i) {
    for (int d = 0; d < 3; ++d) {
      Real const high = static_cast<Real>(sources[i][d]);
      records[i * record_ + d] = high;
      if constexpr (split_coordinates) records[i * record_ + 3 + d] = static_cast<Real>(sources[i][d] - high);
    }
  });
}

template <class Real>
void NearField<Real>::set_strengths(Vec3d const* strengths, Vec3d const* normals) {
  strengths_ = strengths;
  normals_ = normals;
  constexpr int offset = split_coordinates ? 6 : 3;
  for_blocks("NearField::set_strengths", static_cast<long>(lists_.sources().size()), [&](long i) {
    Real* const record = records_.data() + i * record_ + offset;
    for (int d = 0; d < 3; ++d) record[d] = static_cast<Real>(strengths[i][d]);
    if (normals)
      for (int d = 0; d < 3; ++d) record[3 + d] = static_cast<Real>(normals[i][d]);
  });
}

// One pair in double; r and 1 / r may carry derivatives.
template <class Real>
template <class Kernel, class Number>
void NearField<Real>::add_pair(int level, std::uint32_t source, Number const (&r)[3], double r2, Number const& inverse,
                               Number (&u)[3]) const {
  NearLevel<Real> const& part = levels_[level];
  double const to_pieces = static_cast<double>(part.to_pieces);
  int const piece = std::min(static_cast<int>(std::min(to_pieces * r2, 1e6)), local_.pieces - 1);
  Number const x = (r[0] * r[0] + r[1] * r[1] + r[2] * r[2]) * Number(to_pieces) - Number(0.5 + piece);
  Number a = 0.0, b = 0.0, strength[6];
  for (int k = local_.terms - 1; k >= 0; --k) {
    a = a * x + Number(part.a[k * local_.pieces + piece]);
    b = b * x + Number(part.b[k * local_.pieces + piece]);
  }
  for (int d = 0; d < 3; ++d) {
    strength[d] = strengths_[source][d];
    strength[3 + d] = normals_ ? normals_[source][d] : 0.0;
  }
  auto const inside = [&](Number const& n) { return r2 < part.cutoff2 ? n : Number(0.0); };
  Kernel::add(r, inverse, a, b, inside, strength, u);
}

// The sum over the sources that nearly touch a target, one pair at a time.
template <class Real>
template <class Kernel>
void NearField<Real>::add_close(NearLists::Leaf const& leaf, Vec3d* velocity, Vec3d* gradient) const {
  using D = Dual<double>;
  for (auto const& [target, source, level] : leaf.close) {
    Vec3d const x = lists_.targets()[target] - lists_.sources()[source];
    double const r2 = dot(x, x), s = r2 > 0.0 ? 1.0 / std::sqrt(r2) : 0.0;
    Vec3<D> const r = differentiable(x);
    D const place[3] = {r.x, r.y, r.z};
    D u[3];
    add_pair<Kernel>(level, source, place, r2, differentiable_inverse(x, s), u);
    for (int d = 0; d < 3; ++d) {
      velocity[target][d] += velocity_scale_ * u[d].value;
      if (!gradient) continue;
      for (int e = 0; e < 3; ++e) gradient[3L * target + d][e] += velocity_scale_ * lists_.side() * u[d].slope[e];
    }
  }
}

template <class Real>
void NearField<Real>::add(long item, Vec3d* velocity, Vec3d* gradient, Real* work) const {
  NearLists::Leaf const& leaf = lists_.leaves()[item];
  Real* const reactions = leaf.n_place > 0 ? work + 4 * leaf.first_place : nullptr;
  std::fill_n(reactions, 4 * leaf.n_place, Real(0));
  NearWork<Real> const near{kernel_, local_.terms, refinement_steps_, levels_.data(),
                            records_.data(), record_, &lists_.targets().data()->x, leaf.groups.data(),
                            static_cast<long>(leaf.groups.size()), leaf.segments.data(), leaf.list.data(),
                            velocity_scale_, velocity_scale_ * lists_.side(), reactions,
                            outer_levels_.empty() ? nullptr : outer_levels_.data(), outer_.terms,
                            leaf.outer_segments.data(), leaf.outer_list.data()};
  loops_.add_near(near, &velocity->x, gradient ? &gradient->x : nullptr);
  if (leaf.close.empty()) return;
  if (kernel_ == FastKernel::stokeslet) return add_close<NearStokeslet>(leaf, velocity, gradient);
  if (kernel_ == FastKernel::rotlet) return add_close<NearRotlet>(leaf, velocity, gradient);
  if (kernel_ == FastKernel::stokeslet_pressure) return add_close<NearStokesletPressure>(leaf, velocity, gradient);
  if (kernel_ == FastKernel::stresslet_pressure) return add_close<NearStressletPressure>(leaf, velocity, gradient);
  add_close<NearStresslet>(leaf, velocity, gradient);
}

template <class Real>
void NearField<Real>::add_reactions(long item, Vec3d* velocity, Real const* work) const {
  for (auto const& [points, place, leaf] : lists_.reactions_at(item)) {
    Real const* reaction = work + 4 * place;
    for (long i = points.begin; i < points.end; ++i, reaction += 4)
      for (int d = 0; d < 3; ++d) velocity[i][d] += velocity_scale_ * static_cast<double>(reaction[d]);
  }
}

template <class Real>
std::size_t NearField<Real>::memory() const {
  return records_.capacity() * sizeof(Real) + lists_.memory();
}

template class NearField<float>;
template class NearField<double>;

}  // namespace asterflow
