#pragma once
// Watches every Kokkos launch and allocation of the test program: profiles and memory reports are only
// readable when each label starts with "asterflow::". Kokkos' own helpers ("Kokkos::...") are exempt.

#include <functional>
#include <map>
#include <string>

namespace asterflow {

// Starts watching; the violations found are reported as a failure when the test program ends.
void watch_kokkos_labels();

// How often each label was launched or allocated during an action.
std::map<std::string, int> launches_during(std::function<void()> const& action);

}  // namespace asterflow
