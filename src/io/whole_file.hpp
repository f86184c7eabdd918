#pragma once
// A file that is there whole or not at all: one of the same name stays until the new one is written.

#include "base/error.hpp"

#include <filesystem>
#include <fstream>

namespace asterflow {

// write(part) writes a file beside `path`, which then takes its place; nothing of it is left when that throws.
template <class Write>
void write_whole(std::filesystem::path const& path, Write const& write) {
  std::filesystem::path const part = path.string() + ".part";
  try {
    write(part);
    std::error_code error;
    std::filesystem::rename(part, path, error);
    if (error) throw SceneError(path.string() + ": cannot be written: " + error.message());
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove(part, ignored);
    throw;
  }
}

// write(stream) writes its text.
template <class Write>
void write_whole_text(std::filesystem::path const& path, Write const& write) {
  write_whole(path, [&](std::filesystem::path const& part) {
    std::ofstream file(part);
    write(file);
    file.close();
    if (!file) throw SceneError(path.string() + ": cannot be written; is the disk full or the folder protected?");
  });
}

}  // namespace asterflow
