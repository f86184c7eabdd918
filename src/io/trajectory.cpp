#include "io/trajectory.hpp"

#include "base/error.hpp"
#include "io/array_file.hpp"
#include "io/output_folder.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sstream>
#include <sys/file.h>
#include <unistd.h>
#include <utility>

namespace asterflow {

namespace fs = std::filesystem;

namespace {

constexpr std::int64_t layout = 1;  // raised when a file of an earlier program can no longer be read

fs::path current(fs::path const& folder) { return folder / "trajectory.h5"; }
fs::path next(fs::path const& folder) { return folder / "trajectory-next.h5"; }
fs::path former(fs::path const& folder) { return folder / "trajectory-former.h5"; }

std::string frame_name(std::size_t i) { return fmt::format("frames/{:06}", i); }

[[noreturn]] void fail_to_write(fs::path const& path, int error) {
  throw SceneError(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(error)));
}

// The file's content is on the disk afterwards.
void synchronise(fs::path const& path) {
  int const file = ::open(path.c_str(), O_RDONLY);
  if (file < 0) fail_to_write(path, errno);
  int const status = ::fsync(file);
  int const error = errno;
  ::close(file);
  if (status != 0 && error != EINVAL && error != EROFS) fail_to_write(path, error);
}

std::size_t bytes_of(std::vector<NamedArray> const& arrays) {
  std::size_t bytes = 1 << 16;
  for (auto const& array : arrays)
    bytes += 4096 + 8 * std::visit([](auto const& values) { return values.size(); }, array.values);
  return bytes;
}

// Takes room on the disk before HDF5 needs it: the library cannot recover from a write that fails.
void reserve(fs::path const& path, std::size_t bytes) {
  int const file = ::open(path.c_str(), O_RDWR);
  if (file < 0) fail_to_write(path, errno);
  auto const size = ::lseek(file, 0, SEEK_END);
  int const error = ::posix_fallocate(file, size, static_cast<off_t>(bytes));
  if (error != 0 && ::ftruncate(file, size) != 0) fail_to_write(path, errno);
  ::close(file);
  if (error != 0 && error != EINVAL && error != EOPNOTSUPP) fail_to_write(path, error);
}

std::string text_of(std::vector<std::string> const& overrides) { return fmt::format("{}", fmt::join(overrides, "\n")); }

void write_header(fs::path const& path, TrajectoryHeader const& header) {
  ArrayFile file(path, ArrayFile::Mode::create);
  file.write({"header/layout", {}, std::vector<std::int64_t>{layout}, ""});
  file.write({"header/seed", {}, std::vector<std::int64_t>{static_cast<std::int64_t>(header.seed)}, ""});
  file.write_text("header/units", "length um, time s, force pN, torque pN um, viscosity pN s/um^2");
  file.write_text("header/versions", header.versions);
  file.write_text("header/scene", header.scene_text);
  file.write_text("header/scene_file", header.scene_file);
  file.write_text("header/overrides", text_of(header.overrides));
  file.close();
}

void write_frame(ArrayFile& file, Frame const& frame) {
  std::string const group = frame_name(file.has("time") ? file.shape("time").at(0) : 0);
  file.write({group + "/time", {}, std::vector<double>{frame.time}, "s"});
  for (NamedArray array : frame.arrays) {
    array.name = group + "/" + array.name;
    file.write(array);
  }
  file.append("time", frame.time, "s");
}

// Call with the folder locked: before its first state another run has only its second copy there.
void refuse_used_folder(fs::path const& folder) {
  if (fs::exists(current(folder)))
    throw SceneError(fmt::format("{}: is there already; choose another folder with -o, or go on with: asterflow resume {}",
                                 current(folder).string(), folder.string()));
  fs::remove(next(folder));  // of a run that was killed before its first state
  if (!fs::is_empty(folder)) throw SceneError(folder.string() + ": is not empty; choose another output folder with -o");
}

}  // namespace

TrajectoryWriter::TrajectoryWriter(fs::path folder) : folder_(std::move(folder)) {
  lock_ = ::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (lock_ < 0) fail_to_write(folder_, errno);
  if (::flock(lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    ::close(lock_);
    throw SceneError(folder_.string() + ": another asterflow is writing here; wait for it or stop it");
  }
  if (::access(folder_.c_str(), W_OK) != 0) {
    int const error = errno;
    ::close(lock_);
    fail_to_write(folder_, error);
  }
}

TrajectoryWriter::TrajectoryWriter(TrajectoryWriter&& other) noexcept
    : folder_(std::move(other.folder_)), lock_(std::exchange(other.lock_, -1)), next_exists_(other.next_exists_),
      last_(std::move(other.last_)), overrides_(std::move(other.overrides_)) {}

TrajectoryWriter::~TrajectoryWriter() {
  if (lock_ < 0) return;
  std::error_code ignored;
  fs::remove(next(folder_), ignored);
  ::close(lock_);
}

TrajectoryWriter TrajectoryWriter::create(fs::path folder, TrajectoryHeader const& header) {
  make_output_folder(folder);
  TrajectoryWriter writer(std::move(folder));
  refuse_used_folder(writer.folder_);
  writer.overrides_ = text_of(header.overrides);
  write_header(next(writer.folder_), header);
  synchronise(next(writer.folder_));
  fs::rename(next(writer.folder_), current(writer.folder_));
  return writer;
}

TrajectoryWriter TrajectoryWriter::resume(fs::path folder, std::vector<std::string> const& overrides) {
  TrajectoryReader const check(folder);
  TrajectoryWriter writer(std::move(folder));
  writer.overrides_ = text_of(overrides);
  fs::remove(next(writer.folder_));
  fs::remove(former(writer.folder_));
  return writer;
}

void TrajectoryWriter::append(Frame frame, std::vector<NamedArray> const& restart) {
  for (bool is_stored = false; !is_stored;) {
    bool const was_fresh = !next_exists_;
    try {
      write_next(frame, restart);
      exchange_copies();
      is_stored = true;
    } catch (std::exception const& error) {
      std::error_code ignored;
      fs::remove(next(folder_), ignored);
      next_exists_ = false;
      if (was_fresh)
        throw SceneError(fmt::format("{}; the state at t = {:g} s is not stored, all before it is safe: make room and go "
                                     "on with: asterflow resume {}", error.what(), frame.time, folder_.string()));
    }  // somebody may have opened the second copy while it was the first: try again with a fresh one
  }
  last_ = std::move(frame);
}

void TrajectoryWriter::write_next(Frame const& frame, std::vector<NamedArray> const& restart) {
  fs::path const path = next(folder_);
  if (!next_exists_) fs::copy_file(current(folder_), path, fs::copy_options::overwrite_existing);
  reserve(path, bytes_of(frame.arrays) + bytes_of(restart) + (next_exists_ ? bytes_of(last_.arrays) : 0));
  ArrayFile file(path, ArrayFile::Mode::append);
  if (next_exists_) write_frame(file, last_);
  write_frame(file, frame);
  if (file.read_text("header/overrides") != overrides_) {
    file.remove("header/overrides");
    file.write_text("header/overrides", overrides_);
  }
  file.remove("restart");
  for (NamedArray array : restart) {
    array.name = "restart/" + array.name;
    file.write(array);
  }
  file.close();
  synchronise(path);
}

void TrajectoryWriter::exchange_copies() {
  std::error_code error;
  fs::create_hard_link(current(folder_), former(folder_), error);
  next_exists_ = !error;  // a file system without links: the second copy is made anew each time
  fs::rename(next(folder_), current(folder_));
  if (next_exists_) fs::rename(former(folder_), next(folder_));
  ::fsync(lock_);
}

TrajectoryReader::TrajectoryReader(fs::path const& folder) : path_(current(folder).string()) {
  if (!fs::exists(path_)) throw SceneError(folder.string() + ": holds no trajectory.h5; give the output folder of a run");
  ArrayFile const file(path_, ArrayFile::Mode::read);
  if (!file.has("header/layout")) throw SceneError(path_ + ": is not a trajectory of asterflow");
  auto const whole = [&](char const* name) {
    NamedArray const array = file.read(name);
    auto const* values = std::get_if<std::vector<std::int64_t>>(&array.values);
    return values && !values->empty() ? values->front() : 0;
  };
  if (auto const found = whole("header/layout"); found != layout)
    throw SceneError(fmt::format("{}: has layout {}, this program reads {}", path_, found, layout));
  header_.seed = static_cast<std::uint64_t>(whole("header/seed"));
  header_.versions = file.read_text("header/versions");
  header_.scene_text = file.read_text("header/scene");
  header_.scene_file = file.read_text("header/scene_file");
  std::istringstream overrides(file.read_text("header/overrides"));
  for (std::string line; std::getline(overrides, line);) header_.overrides.push_back(line);
  if (file.has("time")) times_ = std::get<std::vector<double>>(file.read("time").values);
}

Frame TrajectoryReader::frame(std::size_t i) const {
  ArrayFile const file(path_, ArrayFile::Mode::read);
  Frame frame{times_.at(i), file.read_group(frame_name(i)), path_ + ": " + frame_name(i)};
  std::erase_if(frame.arrays, [](NamedArray const& array) { return array.name == "time"; });
  return frame;
}

void TrajectoryReader::require_states() const {
  if (times_.empty())
    throw SceneError(fmt::format("{}: holds no states yet; go on with: asterflow resume {}", path_,
                                 fs::path(path_).parent_path().string()));
}

std::size_t TrajectoryReader::nearest(double time) const {
  require_states();
  if (time >= times_.back()) return times_.size() - 1;
  auto const distance = [&](double a, double b) { return std::abs(a - time) < std::abs(b - time); };
  return std::min_element(times_.begin(), times_.end(), distance) - times_.begin();
}

std::vector<NamedArray> TrajectoryReader::restart() const {
  return ArrayFile(path_, ArrayFile::Mode::read).read_group("restart");
}

}  // namespace asterflow
