#include "label_check.hpp"

#include <Kokkos_Core.hpp>
#include <gtest/gtest.h>

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  if (GTEST_FLAG_GET(list_tests)) return RUN_ALL_TESTS();  // Kokkos may print at its start
  Kokkos::ScopeGuard kokkos(argc, argv);
  asterflow::watch_kokkos_labels();
  return RUN_ALL_TESTS();
}
