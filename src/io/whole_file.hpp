#pragma once
// A file that is there whole or not at all: one of the same name stays until the new one is written.

#include <filesystem>

namespace asterflow {

// write(part) writes a file beside `path`, which then takes its place; nothing of it is left when that throws.
template <class Write>
void write_whole(std::filesystem::path const& path, Write const& write) {
  std::filesystem::path const part = path.string() + ".part";
  try {
    write(part);
    std::filesystem::rename(part, path);
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove(part, ignored);
    throw;
  }
}

}  // namespace asterflow
