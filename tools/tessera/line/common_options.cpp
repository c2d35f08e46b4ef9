#include "line/common_options.h"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cstdlib>

#include "line/arguments.h"
#include "tessera/execution.h"

namespace tessera::cli {
namespace {

/// Selects an instruction set for all evaluation of this process, as the environment variable does.
void force_isa(const std::string& name) {
  const Result<Isa> isa = parse_isa(name);
  if (!isa) throw UsageError("--isa", isa.status().message());
  ::setenv("TESSERA_ISA", name.c_str(), 1);
}

}  // namespace

void add_common(Command& command, CommonOptions& options) {
  constexpr std::size_t max_threads = 1024;
  command.begin_group("Options of every command");
  command.add_flag("--json", "Print one JSON object per line, for programs", options.json);
  command.add_flag("--timings", "Print the seconds of each phase", options.timings);
  command.add_count("--threads", "N", "Number of threads [all of the machine]", 1, max_threads,
                    [&options](std::size_t count) { options.threads = static_cast<int>(count); });
  command.add_choice("--isa", {"sse2", "avx2", "avx512"}, "Instruction set of the evaluation [the machine's best]",
                     force_isa);
  command.add_help();
}

Status with_threads(int threads, const std::function<Status()>& work) {
  if (threads == 0) return work();
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  Status status;
  arena.execute([&] { status = work(); });
  return status;
}

}  // namespace tessera::cli
