#pragma once
// Who receives the flow of images behind a periphery, and how: nodes near it by their sum, those deep inside from the sum at the nodes
// of a smaller copy of the periphery (surface/inner_shell.hpp). Images are many and most nodes lie deep.

#include "surface/inner_shell.hpp"

#include <functional>
#include <optional>

namespace asterflow {

class DeepTargets {
 public:
  // As InnerShell, which is made for the first targets that are worth it.
  DeepTargets(std::shared_ptr<DirichletFlow const> periphery, bool is_rough, double accuracy)
      : periphery_(std::move(periphery)), is_rough_(is_rough), accuracy_(accuracy) {}

  // targets [n] um, which `sources` images will act on; the first of them planned for the periphery's own flow, too.
  void place(ConstPoints targets, DirichletFlow::Targets const& planned, std::size_t sources);

  // velocity [n] += flow of the images at the targets; sum(points, u) adds it to u at points in the fluid.
  void add_velocity(std::function<void(ConstPoints, Points)> const& sum, ConstPoints targets, Points velocity) const;

  std::size_t memory() const;  // bytes

 private:
  std::shared_ptr<DirichletFlow const> periphery_;
  bool is_rough_;
  double accuracy_;
  std::optional<InnerShell> shell_;
  bool has_deep_ = false;             // else the images are summed at all targets
  PointArray points_;                 // where they are summed: targets that are not deep, nodes of the copy
  std::vector<std::size_t> shallow_;  // which targets
};

}  // namespace asterflow
