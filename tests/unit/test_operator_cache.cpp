#include "surface/operator_cache.hpp"

#include "cache_fixture.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

using namespace asterflow;

namespace {

class OperatorCache : public CacheFixture {
 protected:
  static OperatorKey key(double radius, int order = 6) {
    ShapeSpec const spec{.radius = radius};
    return OperatorKey(Surface(make_shape(spec), order), Side::interior, 8, 1e-6);
  }
  ShellOperator::Matrices const matrices_{Eigen::MatrixXd::Random(3, 5), Eigen::MatrixXd(0, 0), Eigen::MatrixXd::Random(2, 2)};
};

}  // namespace

TEST_F(OperatorCache, gives_back_exactly_what_was_stored_under_the_same_key_only) {
  EXPECT_TRUE(read_operator(key(1.0)).empty());
  write_operator(key(1.0), matrices_);
  EXPECT_EQ(read_operator(key(1.0)), matrices_);
  EXPECT_TRUE(read_operator(key(1.0 + 1e-12)).empty());
  EXPECT_TRUE(read_operator(key(1.0, 7)).empty());
}

TEST_F(OperatorCache, ignores_damaged_and_foreign_files_and_replaces_them) {
  write_operator(key(1.0), matrices_);
  auto const path = only_file();
  auto const size = std::filesystem::file_size(path);
  for (auto const keep : {std::uintmax_t{0}, std::uintmax_t{10}, size / 2, size - 1}) {
    std::filesystem::resize_file(path, keep);
    EXPECT_TRUE(read_operator(key(1.0)).empty()) << keep;
    write_operator(key(1.0), matrices_);
  }
  {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(size - 20));
    file.put('x');
  }
  EXPECT_TRUE(read_operator(key(1.0)).empty());
  std::filesystem::copy_file(path, path.string() + "2");
  std::filesystem::remove(path);
  write_operator(key(2.0), matrices_);
  EXPECT_EQ(read_operator(key(2.0)), matrices_);
}

TEST_F(OperatorCache, goes_without_where_nothing_can_be_written) {
  std::ofstream(folder_) << "a file where the folder should be";
  write_operator(key(1.0), matrices_);
  EXPECT_TRUE(read_operator(key(1.0)).empty());
  setenv("ASTERFLOW_CACHE", "off", 1);
  write_operator(key(1.0), matrices_);
  EXPECT_TRUE(read_operator(key(1.0)).empty());
}

TEST_F(OperatorCache, serves_writers_and_readers_at_once) {
  std::vector<std::thread> threads;
  std::atomic<int> damaged = 0;
  for (int i = 0; i < 4; ++i)
    threads.emplace_back([&] {
      for (int k = 0; k < 30; ++k) {
        write_operator(key(1.0), matrices_);
        auto const read = read_operator(key(1.0));
        if (!read.empty() && read != matrices_) ++damaged;
      }
    });
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(damaged, 0);
  EXPECT_EQ(read_operator(key(1.0)), matrices_);
}
