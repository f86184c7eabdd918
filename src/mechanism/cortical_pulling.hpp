#pragma once
// Cortical pulling [paper, A.2.2; Kimura & Onami 2007]: motors on sites of the cortex capture plus ends and pull them.
//   capture     a free site captures a growing plus end within its reach at the rate k times a factor: 1 on the anterior
//               side of the dividing plane; on the posterior side linear in the distance along the axis, from one value
//               at the plane to another at the pole. One fiber a site.
//   pull        force F outwards on the plus end, along the fiber or along the normal of the cortex
//   length      the fiber depolymerises (or grows, at most at V_g) so that its plus end stays at the cortex
//   detachment  at the rate 1 / residence time; then the fiber shrinks

#include "fiber/dynamic_instability.hpp"
#include "mechanism/cortex_surface.hpp"
#include "mechanism/cortical_pulling_spec.hpp"

namespace asterflow {

class CorticalPulling {
 public:
  CorticalPulling(CorticalPullingSpec const& spec, CortexSurface const& cortex, std::uint64_t seed);

  void add_tip();  // in the order of the tips of DynamicInstability

  PointArray const& sites() const { return sites_; }              // [n_site] um
  double rate_at(Vec3d site, double plane) const;                 // 1/s; the dividing plane along the axis, um
  int site_of(std::size_t tip) const { return now_[tip].site; }   // -1: none

  // What a tip at that place meets in a step. `plane`: where the dividing plane is, um.
  void surround(std::size_t tip, Vec3d place, double plane, TipSurroundings& surroundings) const;
  // After the tips have been advanced: gives sites to those captured. Returns the tips that come too late: their
  // capture must not happen.
  std::vector<std::size_t> assign(std::span<DynamicInstability::Tip const> trial, ConstPoints places, double plane);

  // Force on a captured plus end, pN.
  Vec3d pull(Vec3d plus_end, Vec3d tangent) const;
  // Force on a tip that is captured at the beginning of the step, pN.
  Vec3d last_pull(std::size_t tip) const { return now_[tip].pull; }
  // The length that puts a plus end on the cortex, um: that of a fiber of `length` whose plus end is there.
  double length_at_cortex(double length, Vec3d plus_end, Vec3d tangent) const;

  // Completes a step of a tip: the pull (pN) and how fast the fiber lengthens (um/s) at its end.
  void advance(std::size_t tip, bool is_captured, Vec3d pull, double speed);
  void accept();

  std::vector<NamedArray> state() const;
  void restore(std::span<NamedArray const> state);

 private:
  struct Hold {
    int site = -1;
    Vec3d pull{};        // pN
    double speed = 0.0;  // um/s
  };

  // Free sites in reach of a place and the sum of their rates.
  double reachable(Vec3d place, double plane, std::vector<std::pair<int, double>>& rates) const;

  CorticalPullingSpec spec_;
  CortexSurface cortex_;
  std::uint64_t seed_;
  PointArray sites_;
  double pole_ = 0.0;  // um, of the cortex along the axis
  std::vector<Hold> now_, trial_;
  std::vector<char> is_taken_;  // [n_site] by a tip at the last accepted time
};

}  // namespace asterflow
