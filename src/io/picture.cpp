#include "io/picture.hpp"

#include "base/build_info.hpp"

#include <cerrno>
#include <cstdlib>
#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace asterflow {

namespace fs = std::filesystem;

namespace {

// Exit status of a program run to its end, -1 when it cannot be run.
int run_program(std::vector<std::string> words, bool is_silent) {
  std::vector<char*> arguments;
  for (auto& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (is_silent) {
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  }
  pid_t child = 0;
  int const error = posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) return -1;
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {}
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

// Installed: <prefix>/share/asterflow beside <prefix>/bin; otherwise the source tree that the program was built from.
fs::path find_script(std::string const& name) {
  std::error_code error;
  fs::path const program = fs::read_symlink("/proc/self/exe", error);
  for (fs::path const& folder : {program.parent_path() / ".." / "share" / "asterflow", fs::path(build_info::scripts)})
    if (fs::exists(folder / name, error)) return folder / name;
  return {};
}

std::string find_python() {
  std::vector<std::string> candidates{"python3", "/usr/bin/python3"};
  if (char const* chosen = std::getenv("ASTERFLOW_PYTHON")) candidates = {chosen};
  for (auto const& candidate : candidates)
    if (run_program({candidate, "-c", "import numpy, h5py, matplotlib"}, true) == 0) return candidate;
  return "";
}

}  // namespace

bool draw_picture(std::string const& script, std::vector<std::string> const& arguments) {
  auto const refuse = [](std::string const& reason) {
    fmt::print(stderr, "no picture: {}\n", reason);
    return false;
  };
  fs::path const path = find_script(script);
  if (path.empty()) return refuse(script + " is neither in share/asterflow beside the program nor in its source tree");
  std::string const python = find_python();
  if (python.empty())
    return refuse("no python3 with numpy, h5py and matplotlib (install them, or set ASTERFLOW_PYTHON)");
  std::vector<std::string> words{python, path.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  if (run_program(words, false) != 0) return refuse(fmt::format("{} {} has failed", python, path.string()));
  return true;
}

}  // namespace asterflow
