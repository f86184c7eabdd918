// Writes states to a trajectory as fast as it can, or goes on with one, for the test that kills it. State i holds
// arrays made of i, of a size that changes from state to state.
//   append_states FOLDER COUNT

#include "base/error.hpp"
#include "io/trajectory.hpp"

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

using namespace asterflow;

int main(int argc, char** argv) {
  if (argc != 3) return 1;
  std::signal(SIGXFSZ, SIG_IGN);
  std::filesystem::path const folder = argv[1];
  try {
    std::int64_t i = 0;
    bool const goes_on = std::filesystem::exists(folder / "trajectory.h5");
    auto writer = goes_on ? TrajectoryWriter::resume(folder, {"run.seed=2"})
                          : TrajectoryWriter::create(folder, {"[fluid]\n", "/scene.toml", {"run.seed=2"}, "test", 2});
    if (goes_on)
      for (auto const& array : TrajectoryReader(folder).restart())
        if (array.name == "index") i = std::get<std::vector<std::int64_t>>(array.values).at(0) + 1;
    for (std::int64_t const end = std::atoll(argv[2]); i < end; ++i) {
      PointArray const points(50 + (i * 37) % 400, Vec3d{double(i), 2.0, 3.0});
      writer.append({0.5 * double(i), {NamedArray::of("fiber/position", points, "um")}},
                    {NamedArray::of("index", std::vector<std::int64_t>{i}), NamedArray::of("fiber/state", points, "um")});
    }
  } catch (SceneError const& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
