#pragma once
// Named arrays and texts in one HDF5 file. The only place that calls the HDF5 library. Every failure is a
// SceneError of one line that names the file and the dataset.

#include "base/named_array.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace asterflow {

class ArrayFile {
 public:
  enum class Mode { read, create, append };  // create replaces an existing file

  ArrayFile(std::string path, Mode mode);
  ~ArrayFile();  // closes, ignoring failures
  ArrayFile(ArrayFile const&) = delete;
  ArrayFile& operator=(ArrayFile const&) = delete;

  // Everything written is with the operating system afterwards.
  void close();

  bool has(std::string const& name) const;
  std::vector<std::string> list(std::string const& group) const;  // in alphabetical order; empty when absent
  std::vector<std::size_t> shape(std::string const& name) const;

  NamedArray read(std::string const& name) const;       // numbers of any kind
  PointArray read_points(std::string const& name) const;  // [n, 3]
  std::string read_text(std::string const& name) const;
  // All arrays below a group, with names relative to it.
  std::vector<NamedArray> read_group(std::string const& group) const;

  void write(NamedArray const& array);  // groups on the way are made
  void write_text(std::string const& name, std::string const& text);
  void append(std::string const& name, double value, std::string const& unit);  // to a list that grows
  void remove(std::string const& name);  // when present

 private:
  [[noreturn]] void fail(std::string const& name, std::string const& what) const;

  std::string path_;
  std::int64_t file_ = -1;  // HDF5 identifier
};

}  // namespace asterflow
