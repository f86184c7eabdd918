#include "label_check.hpp"

#include <Kokkos_Core.hpp>
#include <gtest/gtest.h>
#include <mutex>
#include <set>
#include <string>
#include <string_view>

namespace asterflow {
namespace {

std::mutex guard;
std::set<std::string> wrong_labels;
std::map<std::string, int>* counts = nullptr;  // while somebody counts

void check_label(char const* label) {
  std::string_view const text = label;
  if (counts) {
    std::scoped_lock lock(guard);
    ++(*counts)[label];
  }
  if (text.starts_with("asterflow::") || text.starts_with("Kokkos::")) return;
  if (text == "[unlabeled]") return;  // memory that Kokkos takes for its own thread teams; a view would say ""
  std::scoped_lock lock(guard);
  wrong_labels.emplace(text);
}

void check_launch(char const* label, std::uint32_t, std::uint64_t*) { check_label(label); }

void check_allocation(Kokkos::Tools::SpaceHandle, char const* label, void const*, std::uint64_t) {
  check_label(label);
}

class LabelEnvironment : public testing::Environment {
  void TearDown() override {
    for (auto const& label : wrong_labels) {
      ADD_FAILURE() << "Kokkos label \"" << label << "\" does not start with asterflow::";
    }
  }
};

}  // namespace

std::map<std::string, int> launches_during(std::function<void()> const& action) {
  std::map<std::string, int> launches;
  counts = &launches;
  action();
  counts = nullptr;
  return launches;
}

void watch_kokkos_labels() {
  namespace tools = Kokkos::Tools::Experimental;
  tools::set_begin_parallel_for_callback(check_launch);
  tools::set_begin_parallel_reduce_callback(check_launch);
  tools::set_begin_parallel_scan_callback(check_launch);
  tools::set_allocate_data_callback(check_allocation);
  testing::AddGlobalTestEnvironment(new LabelEnvironment);  // owned by GoogleTest
}

}  // namespace asterflow
