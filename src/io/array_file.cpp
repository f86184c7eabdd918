#include "io/array_file.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <hdf5.h>

namespace asterflow {

namespace {

// Files are closed here. What the library would do as the program ends crashes where a full disk kept one from closing.
[[maybe_unused]] int const does_not_end_library = H5dont_atexit();

// An HDF5 identifier that is released at the end of its scope.
class Handle {
 public:
  Handle(hid_t id, herr_t (*release)(hid_t)) : id_(id), release_(release) {}
  ~Handle() { if (id_ >= 0) release_(id_); }
  Handle(Handle const&) = delete;
  Handle& operator=(Handle const&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*release_)(hid_t);
};

Handle intermediate_groups() {
  hid_t const list = H5Pcreate(H5P_LINK_CREATE);
  H5Pset_create_intermediate_group(list, 1);
  return {list, H5Pclose};
}

bool write_unit(hid_t dataset, std::string const& unit) {
  if (unit.empty()) return true;
  Handle const type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, unit.size());
  Handle const space(H5Screate(H5S_SCALAR), H5Sclose);
  Handle const attribute(H5Acreate2(dataset, "unit", type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  return attribute >= 0 && H5Awrite(attribute, type, unit.c_str()) >= 0;
}

std::string read_unit(hid_t dataset) {
  if (H5Aexists(dataset, "unit") <= 0) return "";
  Handle const attribute(H5Aopen(dataset, "unit", H5P_DEFAULT), H5Aclose);
  Handle const type(H5Aget_type(attribute), H5Tclose);
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type)) return "";
  std::string unit(H5Tget_size(type), '\0');
  return H5Aread(attribute, type, unit.data()) >= 0 ? unit : "";
}

std::vector<std::size_t> shape_of(hid_t dataset) {
  Handle const space(H5Dget_space(dataset), H5Sclose);
  int const rank = H5Sget_simple_extent_ndims(space);
  std::vector<hsize_t> extent(std::max(rank, 0));
  if (rank > 0) H5Sget_simple_extent_dims(space, extent.data(), nullptr);
  return {extent.begin(), extent.end()};
}

}  // namespace

ArrayFile::ArrayFile(std::string path, Mode mode) : path_(std::move(path)) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // our messages, not the library's
  std::error_code ignored;
  if (mode != Mode::create) {
    if (!std::filesystem::exists(path_, ignored)) throw SceneError(path_ + ": no such file");
    if (std::filesystem::is_directory(path_, ignored)) throw SceneError(path_ + ": is a folder, not an HDF5 file");
  }
  errno = 0;
  switch (mode) {
    case Mode::read: file_ = H5Fopen(path_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT); break;
    case Mode::append: file_ = H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT); break;
    case Mode::create: file_ = H5Fcreate(path_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT); break;
  }
  if (file_ >= 0) return;
  bool const is_place_missing = mode == Mode::create && (errno == ENOENT || errno == ENOTDIR);
  std::string const cause = is_place_missing || errno == EACCES || errno == EROFS || errno == ENOSPC
                                ? std::strerror(errno)
                                : "not an HDF5 file, or a truncated one, or in use by another program";
  throw SceneError(fmt::format("{}: cannot be {}: {}", path_, mode == Mode::create ? "written" : "opened", cause));
}

ArrayFile::~ArrayFile() {
  if (file_ >= 0) H5Fclose(file_);
}

void ArrayFile::close() {
  bool const flushed = H5Fflush(file_, H5F_SCOPE_LOCAL) >= 0;
  bool const closed = H5Fclose(file_) >= 0;
  file_ = -1;
  if (!flushed || !closed) throw SceneError(path_ + ": cannot be written: the disk is full or failing");
}

void ArrayFile::fail(std::string const& name, std::string const& what) const {
  throw SceneError(fmt::format("{}: dataset \"{}\": {}", path_, name, what));
}

bool ArrayFile::has(std::string const& name) const {
  for (std::size_t slash = name.find('/', 1);; slash = name.find('/', slash + 1)) {
    if (H5Lexists(file_, name.substr(0, slash).c_str(), H5P_DEFAULT) <= 0) return false;
    if (slash == std::string::npos) return true;
  }
}

std::vector<std::string> ArrayFile::list(std::string const& group) const {
  if (!has(group)) return {};
  std::vector<std::string> names;
  auto const collect = [](hid_t, char const* name, H5L_info_t const*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return 0;
  };
  Handle const id(H5Gopen2(file_, group.c_str(), H5P_DEFAULT), H5Gclose);
  if (id < 0 || H5Literate(id, H5_INDEX_NAME, H5_ITER_INC, nullptr, collect, &names) < 0)
    fail(group, "cannot be listed; the file is damaged");
  return names;
}

std::vector<std::size_t> ArrayFile::shape(std::string const& name) const {
  if (!has(name)) fail(name, "is missing");
  Handle const dataset(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (dataset < 0) fail(name, "is not a dataset");
  return shape_of(dataset);
}

NamedArray ArrayFile::read(std::string const& name) const {
  NamedArray array{name, shape(name), {}, ""};
  Handle const dataset(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose);
  Handle const type(H5Dget_type(dataset), H5Tclose);
  auto const kind = H5Tget_class(type);
  if (kind != H5T_FLOAT && kind != H5T_INTEGER) fail(name, "must hold numbers");
  std::size_t n = 1;
  for (std::size_t extent : array.shape) n *= extent;
  if (H5Dget_storage_size(dataset) == 0 && n > 0) fail(name, "has never been written");
  Handle const storage(H5Dget_create_plist(dataset), H5Pclose);
  if (H5Pall_filters_avail(storage) == 0)
    fail(name, "is compressed in a way that this HDF5 library cannot undo; write it without compression, or with gzip");
  herr_t status = 0;
  if (kind == H5T_INTEGER) {
    std::vector<std::int64_t> values(n);
    if (n > 0) status = H5Dread(dataset, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    array.values = std::move(values);
  } else {
    std::vector<double> values(n);
    if (n > 0) status = H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    array.values = std::move(values);
  }
  if (status < 0) fail(name, "cannot be read; the file is truncated or damaged");
  array.unit = read_unit(dataset);
  return array;
}

PointArray ArrayFile::read_points(std::string const& name) const {
  NamedArray const array = read(name);
  if (array.shape.size() != 2 || array.shape[1] != 3)
    fail(name, fmt::format("has shape [{}], must be [n, 3]", fmt::join(array.shape, ", ")));
  PointArray points(array.shape[0]);
  std::visit(
      [&](auto const& values) {
        for (std::size_t i = 0; i < values.size(); ++i) points[i / 3][static_cast<int>(i % 3)] = double(values[i]);
      },
      array.values);
  return points;
}

std::string ArrayFile::read_text(std::string const& name) const {
  if (!has(name)) fail(name, "is missing");
  Handle const dataset(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose);
  Handle const stored(H5Dget_type(dataset), H5Tclose);
  if (dataset < 0 || H5Tget_class(stored) != H5T_STRING || H5Tis_variable_str(stored) <= 0) fail(name, "must be a text");
  Handle const type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, H5T_VARIABLE);
  H5Tset_cset(type, H5T_CSET_UTF8);
  char* text = nullptr;
  if (H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, &text) < 0 || !text) fail(name, "cannot be read");
  std::string result(text);
  H5free_memory(text);
  return result;
}

std::vector<NamedArray> ArrayFile::read_group(std::string const& group) const {
  std::vector<NamedArray> arrays;
  for (auto const& child : list(group)) {
    std::string const path = group + "/" + child;
    H5O_info_t object;
    if (H5Oget_info_by_name(file_, path.c_str(), &object, H5P_DEFAULT) < 0) fail(path, "cannot be opened");
    if (object.type == H5O_TYPE_GROUP) {
      for (auto& array : read_group(path)) {
        array.name = child + "/" + array.name;
        arrays.push_back(std::move(array));
      }
    } else {
      arrays.push_back(read(path));
      arrays.back().name = child;
    }
  }
  return arrays;
}

void ArrayFile::write(NamedArray const& array) {
  std::vector<hsize_t> const extent(array.shape.begin(), array.shape.end());
  Handle const space(extent.empty() ? H5Screate(H5S_SCALAR)
                                    : H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr),
                     H5Sclose);
  Handle const groups = intermediate_groups();
  bool const is_whole = std::holds_alternative<std::vector<std::int64_t>>(array.values);
  hid_t const type = is_whole ? H5T_NATIVE_INT64 : H5T_NATIVE_DOUBLE;
  hid_t const stored = array.single ? H5T_NATIVE_FLOAT : type;
  Handle const dataset(H5Dcreate2(file_, array.name.c_str(), stored, space, groups, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
  std::size_t n = 1;
  for (std::size_t count : array.shape) n *= count;
  bool is_written = dataset >= 0 && write_unit(dataset, array.unit);
  std::visit(
      [&](auto const& values) {
        ASTERFLOW_REQUIRE(values.size() == n);
        if (n > 0 && is_written)
          is_written = H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0;
      },
      array.values);
  if (!is_written) fail(array.name, "cannot be written: the disk is full or failing");
}

void ArrayFile::write_text(std::string const& name, std::string const& text) {
  Handle const type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, H5T_VARIABLE);
  H5Tset_cset(type, H5T_CSET_UTF8);
  Handle const space(H5Screate(H5S_SCALAR), H5Sclose);
  Handle const groups = intermediate_groups();
  Handle const dataset(H5Dcreate2(file_, name.c_str(), type, space, groups, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
  char const* characters = text.c_str();
  if (dataset < 0 || H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, &characters) < 0)
    fail(name, "cannot be written: the disk is full or failing");
}

void ArrayFile::append(std::string const& name, double value, std::string const& unit) {
  hsize_t const one = 1, unlimited = H5S_UNLIMITED, chunk = 512;
  hsize_t n = 0;
  bool is_written = true;
  if (!has(name)) {
    Handle const space(H5Screate_simple(1, &n, &unlimited), H5Sclose);
    Handle const groups = intermediate_groups();
    Handle const storage(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_chunk(storage, 1, &chunk);
    Handle const made(H5Dcreate2(file_, name.c_str(), H5T_NATIVE_DOUBLE, space, groups, storage, H5P_DEFAULT),
                      H5Dclose);
    is_written = made >= 0 && write_unit(made, unit);
  }
  Handle const dataset(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose);
  n = is_written ? shape(name).at(0) : 0;
  hsize_t const extent = n + 1;
  is_written = is_written && H5Dset_extent(dataset, &extent) >= 0;
  Handle const in_file(H5Dget_space(dataset), H5Sclose);
  H5Sselect_hyperslab(in_file, H5S_SELECT_SET, &n, nullptr, &one, nullptr);
  Handle const in_memory(H5Screate_simple(1, &one, nullptr), H5Sclose);
  if (!is_written || H5Dwrite(dataset, H5T_NATIVE_DOUBLE, in_memory, in_file, H5P_DEFAULT, &value) < 0)
    fail(name, "cannot be written: the disk is full or failing");
}

void ArrayFile::remove(std::string const& name) {
  if (has(name)) H5Ldelete(file_, name.c_str(), H5P_DEFAULT);
}

}  // namespace asterflow
