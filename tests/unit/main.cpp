#include "base/parallel.hpp"
#include "label_check.hpp"

#include <gtest/gtest.h>

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  if (GTEST_FLAG_GET(list_tests)) return RUN_ALL_TESTS();  // Kokkos may print at its start
  asterflow::ParallelScope const threads;
  asterflow::watch_kokkos_labels();
  return RUN_ALL_TESTS();
}
