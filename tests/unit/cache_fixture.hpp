#pragma once
// A cache folder of a test's own.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <unistd.h>

class CacheFixture : public testing::Test {
 protected:
  CacheFixture() : folder_(std::filesystem::temp_directory_path() / ("asterflow-test-" + std::to_string(getpid()))) {
    setenv("ASTERFLOW_CACHE", folder_.c_str(), 1);
  }
  ~CacheFixture() override {
    std::filesystem::remove_all(folder_);
    setenv("ASTERFLOW_CACHE", "off", 1);
  }
  std::filesystem::path only_file() const { return std::filesystem::directory_iterator(folder_)->path(); }

  std::filesystem::path folder_;
};
