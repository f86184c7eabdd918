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

  // The way of a plus end in a step: straight until it stops, if it does.
  struct Path {
    Vec3d start;     // um
    Vec3d velocity;  // um/s
    double until;    // s
  };

  void begin_step(double dt);
  // What a tip on that path meets in the step, of sites that are free at its beginning; the rates are valid until they
  // change by one of the calls below. `plane`: where the dividing plane is, um.
  void surround(std::size_t tip, Path const& path, double plane, TipSurroundings& surroundings);
  // A tip is let go, or captured, at a time after the beginning of the step, s: its site is free from then on, or is
  // chosen and taken. Returns the tips whose rates that changes.
  std::vector<std::size_t> let_go(std::size_t tip, double time);
  std::vector<std::size_t> capture(std::size_t tip, DynamicInstability::Tip const& trial, double time);
  std::span<CaptureRate const> rates(std::size_t tip) const { return rates_[tip]; }

  // Force on a captured plus end, pN.
  Vec3d pull(Vec3d plus_end, Vec3d tangent) const;
  // Force on a tip that is captured at the beginning of the step, pN.
  Vec3d last_pull(std::size_t tip) const { return now_[tip].pull; }
  // The length that puts a plus end on the cortex, um: that of a fiber of `length` whose plus end is there.
  double length_at_cortex(double length, Vec3d plus_end, Vec3d tangent) const;

  // Completes a step of a tip: the pull (pN) and how fast the fiber lengthens (um/s) at its end.
  void advance(std::size_t tip, bool is_captured, Vec3d pull, double speed);
  void accept() { now_ = trial_; }

  std::vector<NamedArray> state() const;
  void restore(std::span<NamedArray const> state);

 private:
  struct Hold {
    int site = -1;
    Vec3d pull{};        // pN
    double speed = 0.0;  // um/s
  };

  // Of a tip in reach of a site.
  struct Visit {
    int site;
    double rate;          // 1/s
    double enter, leave;  // s
  };

  struct Availability {
    double from, until;  // s
  };

  void set_rates(std::size_t tip);
  std::vector<std::size_t> change(int site);

  CorticalPullingSpec spec_;
  CortexSurface cortex_;
  std::uint64_t seed_;
  PointArray sites_;
  double pole_ = 0.0;  // um, of the cortex along the axis
  std::vector<Hold> now_, trial_;
  // Of the step:
  double dt_ = 0.0;
  std::vector<Availability> available_;          // [n_site]
  std::vector<std::vector<Visit>> visits_;       // [n_tip]
  std::vector<std::vector<CaptureRate>> rates_;  // [n_tip]
};

}  // namespace asterflow
