#include "io/output_folder.hpp"

#include "base/error.hpp"

#include <fstream>
#include <gtest/gtest.h>

using namespace asterflow;

namespace {

std::string refusal_of(std::filesystem::path const& folder) {
  try {
    make_output_folder(folder);
  } catch (SceneError const& error) {
    return error.what();
  }
  return {};
}

}  // namespace

TEST(OutputFolder, is_made_or_refused_with_the_reason) {
  std::filesystem::path const place = std::filesystem::temp_directory_path() / "asterflow_output_folder";
  std::filesystem::remove_all(place);
  EXPECT_EQ(refusal_of(place / "a" / "b"), "");
  EXPECT_TRUE(std::filesystem::is_directory(place / "a" / "b"));
  std::ofstream(place / "file") << "1";
  EXPECT_NE(refusal_of(place / "file").find("is a file"), std::string::npos);
  EXPECT_NE(refusal_of(place / "file" / "c").find("Not a directory"), std::string::npos);
  std::filesystem::remove_all(place);
}
