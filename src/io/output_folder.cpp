#include "io/output_folder.hpp"

#include "base/error.hpp"

#include <cerrno>
#include <fmt/format.h>
#include <system_error>
#include <unistd.h>

namespace asterflow {

void make_output_folder(std::filesystem::path const& folder) {
  std::error_code error;
  if (std::filesystem::exists(folder, error) && !std::filesystem::is_directory(folder, error))
    throw SceneError(folder.string() + ": is a file; choose another output folder with -o");
  std::filesystem::create_directories(folder, error);
  if (!error && ::access(folder.c_str(), W_OK) != 0) error.assign(errno, std::generic_category());
  if (error)
    throw SceneError(fmt::format("{}: cannot be used for output: {}; choose another folder with -o", folder.string(),
                                 error.message()));
}

}  // namespace asterflow
