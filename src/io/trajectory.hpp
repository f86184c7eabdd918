#pragma once
// The history of a run in one HDF5 file, FOLDER/trajectory.h5:
//
//   header/scene        text   the scene file, whole          header/overrides  text  one table.key=value a line
//   header/scene_file   text   where it was                   header/versions   text  of asterflow and its libraries
//   header/units        text   um, s, pN                      header/seed       whole number
//   time                [n]    s, of the stored states
//   frames/000000/...          the first state: arrays named component/quantity, each with attribute "unit"
//   restart/...                all that is needed to go on from the last state exactly
//
//   import h5py
//   file = h5py.File("FOLDER/trajectory.h5")
//   x = file["frames/000010/body/position"][:]
//
// A kill at any instant leaves a whole file. Two copies exist while a run goes on: trajectory.h5 is never written
// to; the new state goes into trajectory-next.h5, which lags one state behind, and then the two change names
// (rename is atomic). The second copy is removed at the end of the run, and when a killed run is resumed.

#include "base/named_array.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace asterflow {

struct TrajectoryHeader {
  std::string scene_text;
  std::string scene_file;  // absolute path
  std::vector<std::string> overrides;
  std::string versions;
  std::uint64_t seed = 1;
};

struct Frame {
  double time = 0.0;  // s
  std::vector<NamedArray> arrays;
  std::string place = "trajectory";  // file and group, for messages
};

class TrajectoryWriter {
 public:
  // A new trajectory in a folder that is empty or not there yet. Throws SceneError otherwise.
  static TrajectoryWriter create(std::filesystem::path folder, TrajectoryHeader const& header);
  // Goes on with one that is there, under these overrides from the next state on.
  static TrajectoryWriter resume(std::filesystem::path folder, std::vector<std::string> const& overrides);

  ~TrajectoryWriter();
  TrajectoryWriter(TrajectoryWriter&& other) noexcept;
  TrajectoryWriter& operator=(TrajectoryWriter&&) = delete;

  // Stores a state; `restart` replaces the one before. When the disk is full it throws SceneError, and what was
  // stored before is whole.
  void append(Frame frame, std::vector<NamedArray> const& restart);

 private:
  explicit TrajectoryWriter(std::filesystem::path folder);  // locks the folder against a second writer
  void write_next(Frame const& frame, std::vector<NamedArray> const& restart);
  void exchange_copies();

  std::filesystem::path folder_;
  int lock_ = -1;              // file descriptor of the folder
  bool next_exists_ = false;   // trajectory-next.h5 holds all but the last state
  Frame last_;                 // that state
  std::string overrides_;      // text of header/overrides
};

class TrajectoryReader {
 public:
  explicit TrajectoryReader(std::filesystem::path const& folder);

  TrajectoryHeader const& header() const { return header_; }
  std::vector<double> const& times() const { return times_; }  // s
  Frame frame(std::size_t i) const;
  std::size_t nearest(double time) const;  // index of the state closest in time
  void require_states() const;  // SceneError where there is none: the run was killed before its first
  std::vector<NamedArray> restart() const;

 private:
  std::string path_;
  TrajectoryHeader header_;
  std::vector<double> times_;
};

}  // namespace asterflow
