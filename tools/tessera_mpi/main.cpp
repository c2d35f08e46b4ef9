// The commands of tessera that several ranks of MPI share.

#include <tbb/info.h>

#include <algorithm>
#include <csignal>
#include <string>
#include <thread>

#include "commands/commands.h"
#include "console/console.h"
#include "console/output.h"
#include "io/file/output_file.h"
#include "line/help.h"
#include "tessera/execution.h"
#include "tessera/guard.h"
#include "tessera/version.h"
#include "tessera_mpi/mpi_team.h"

namespace tessera::cli { namespace {

constexpr int success = 0, bad_input = 1, bad_command_line = 2;
constexpr const char* hint = "\nTry tessera_mpi --help, or tessera_mpi COMMAND --help.";

void describe_tool(Command& tool) {
  tool.name = "tessera_mpi";
  tool.text = "Commands of tessera that several processes share, by MPI";
  tool.footer =
      "Each rank reads the model. Rank 0 writes the result, which is the same for any number of ranks, byte for byte,\n"
      "and the report. If a rank fails, all end with its message and without a result.\n"
      "\nExit status: 0 done, 1 an input is bad, an output cannot be written or a rank is lost, 2 the command line is "
      "bad.\n"
      "\nExamples:\n"
      "  mpirun -n 4 tessera_mpi raycast teapot.bpt -o teapot.png --size 3840x2160\n"
      "  mpirun -n 4 tessera_mpi eval goblet.json --grid 1000x1000 -o points.csv\n"
      "  mpirun -n 4 tessera_mpi raycast goblet.json --rays rays.csv --hits hits.csv --data-parallel\n"
      "  mpirun -n 4 tessera_mpi tessellate sheet.bpt -o sheet.pvtp --tolerance 0.01";
}

/// A rank cannot end its job alone, so a signal ends it at once; mpirun then ends the others.
extern "C" void end_by(int signal) {
  remove_temporaries();
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void end_at_signals() {
  std::signal(SIGXFSZ, SIG_IGN);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, end_by);
}

/// The ranks of one machine share its processors, unless mpirun has given each its own.
int threads_per_rank() {
  MPI_Comm machine = MPI_COMM_NULL;
  int ranks = 1;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
  MPI_Comm_size(machine, &ranks);
  MPI_Comm_free(&machine);
  const int share = std::max(1, static_cast<int>(std::thread::hardware_concurrency()) / ranks);
  return std::min(share, tbb::info::default_concurrency());
}

int run_command(const Session& session) {
  if (const Result<Isa> isa = default_isa(); !isa) {
    complain(isa.status().message());
    return bad_command_line;
  }
  end_at_signals();
  const int threads = session.common.threads > 0 ? session.common.threads : threads_per_rank();
  const Status status = with_threads(threads, session.command);
  if (!status.ok() && !is_already_said(status)) complain(status.message());
  remove_empty_folders();
  return status.ok() ? success : bad_input;
}

int run(int argc, char** argv, MpiTeam& team) {
  Command tool;
  Session session;
  session.team = &team;
  bool version = false;
  describe_tool(tool);
  tool.add_flag("--version", "Print the version", version);
  tool.add_help();
  add_eval(tool, session);
  add_raycast(tool, session);
  add_tessellate_by_ranks(tool, session, team);
  Parsed parsed;
  Status usage;
  try {
    parsed = parse(tool, argc, argv);
  } catch (const UsageError& error) {
    usage = Status(StatusCode::invalid_argument, error.what() + std::string(hint));
  }
  usage = team.end_job(usage);
  if (!usage.ok()) {
    complain(usage.message());
    return bad_command_line;
  }
  if (parsed.help) return print(help_text(tool, parsed.command ? *parsed.command : tool)).ok() ? success : bad_input;
  if (version) return print("tessera_mpi " TESSERA_VERSION "\n").ok() ? success : bad_input;
  if (session.command) return run_command(session);
  complain("expected a command (eval, raycast or tessellate), found none" + std::string(hint));
  return bad_command_line;
}

}}  // namespace tessera::cli

int main(int argc, char** argv) {
  using namespace tessera::cli;
  int level = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &level);
  int result = bad_input;
  try {
    set_program_name("tessera_mpi");
    const auto team = MpiTeam::make();
    if (!team) end_all_ranks(team.status());
    if (!(*team)->leads()) be_silent();
    result = run(argc, argv, **team);
  } catch (...) {
    end_all_ranks(tessera::status_of_exception());
  }
  MPI_Finalize();
  return result;
}
