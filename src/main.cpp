// The program: chooses a subcommand, starts Kokkos, and turns errors into exit codes
//   0 done   1 bad input   2 numerical failure, state saved   3 internal error

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "command/check.hpp"
#include "command/drag.hpp"
#include "command/export.hpp"
#include "command/flow.hpp"
#include "command/mobility.hpp"
#include "command/observe.hpp"
#include "command/resume.hpp"
#include "command/run.hpp"
#include "command/sum.hpp"
#include "command/torque.hpp"
#include "io/versions.hpp"

#include <csignal>
#include <cstdio>
#include <new>

namespace {

int report(std::string const& message, int code) {
  std::fprintf(stderr, "%s\n", message.c_str());
  return code;
}

// Errors of the command line take one line like all others.
int report_usage(CLI::App const& program, CLI::ParseError const& error) {
  if (error.get_exit_code() == 0) return program.exit(error);  // help and version
  std::string name = "asterflow";
  for (auto const* command : program.get_subcommands()) name += " " + command->get_name();
  return report(name + ": " + error.what() + " (see " + name + " --help)", 1);
}

int run(int argc, char** argv) {
  CLI::App program("asterflow: flexible fibers, rigid bodies and a confining surface in Stokes flow", "asterflow");
  asterflow::Action chosen;
  program.set_version_flag("--version", asterflow::all_versions());
  program.require_subcommand(0, 1);
  program.footer(
      "\nasterflow COMMAND --help explains a command.\n"
      "Exit codes: 0 done, 1 bad input, 2 numerical failure (state saved), 3 internal error.\n"
      "Threads: set OMP_NUM_THREADS.\n");
  for (auto const add : {asterflow::add_run_command, asterflow::add_resume_command, asterflow::add_check_command,
                         asterflow::add_mobility_command, asterflow::add_flow_command, asterflow::add_drag_command,
                         asterflow::add_export_command, asterflow::add_sum_command,
                         asterflow::add_torque_command, asterflow::add_observe_command})
    add(program, chosen);
  try {
    program.parse(argc, argv);
  } catch (CLI::ParseError const& error) {
    return report_usage(program, error);
  }
  if (!chosen) return report("asterflow: a command is missing (see asterflow --help)", 1);
  std::signal(SIGXFSZ, SIG_IGN);  // a file that grows beyond a limit is an error like a full disk
  asterflow::ParallelScope const threads;
  chosen();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (asterflow::SceneError const& error) {
    return report(error.what(), 1);
  } catch (std::bad_alloc const&) {
    return report("asterflow: not enough memory for this input; reduce it or use a larger machine", 1);
  } catch (asterflow::NumericalError const& error) {
    return report(error.what(), 2);
  } catch (std::exception const& error) {
    return report(std::string("asterflow: internal error, please report: ") + error.what(), 3);
  }
}
