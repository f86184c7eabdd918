#include "backends/direct_any_reach.hpp"

#include "backends/backend.hpp"
#include "backends/point_cloud.hpp"

namespace asterflow {
namespace {

class AnyReach final : public Evaluator {
 public:
  AnyReach(std::string_view kernel, std::unique_ptr<Evaluator> scaled)
      : scaled_(std::move(scaled)), plain_(make_reference(kernel, {})) {}

  void set_points(ConstPoints sources, ConstPoints targets, ConstPoints normals) override {
    used_ = (dwarfs_sources(bounding_box(sources, targets), sources, targets) ? plain_ : scaled_).get();
    used_->set_points(sources, targets, normals);
  }
  void add_velocity(ConstPoints strengths, Points velocity) override { used_->add_velocity(strengths, velocity); }
  void add_gradient(ConstPoints strengths, Points gradient) override { used_->add_gradient(strengths, gradient); }

  std::string_view backend() const override { return scaled_->backend(); }
  std::size_t memory() const override { return scaled_->memory() + plain_->memory(); }

 private:
  std::unique_ptr<Evaluator> scaled_, plain_;
  Evaluator* used_ = scaled_.get();
};

}  // namespace

std::unique_ptr<Evaluator> for_any_reach(std::string_view kernel, std::unique_ptr<Evaluator> scaled) {
  return std::make_unique<AnyReach>(kernel, std::move(scaled));
}

}  // namespace asterflow
