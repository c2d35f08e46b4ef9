#include "common_options.h"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <CLI/CLI.hpp>

#include <cstdlib>
#include <utility>

#include "arguments.h"
#include "tessera/execution.h"

namespace tessera::cli {
namespace {

/// Selects an instruction set for all evaluation of this process, as the environment variable does.
void force_isa(const std::string& name) {
  const Result<Isa> isa = parse_isa(name);
  if (!isa) throw CLI::ValidationError("--isa", isa.status().message());
  ::setenv("TESSERA_ISA", name.c_str(), 1);
}

}  // namespace

void add_common(CLI::App& command, CommonOptions& options) {
  constexpr const char* group = "Options of every command";
  constexpr int max_threads = 1024;
  command.add_flag("--json", options.json, "Print one JSON object per line, for programs")->group(group);
  command.add_flag("--timings", options.timings, "Print the seconds of each phase")->group(group);
  command.add_option("--threads", options.threads, "Number of threads [all of the machine]")
      ->type_name("N")
      ->check(whole_number(1, max_threads))
      ->group(group);
  command
      .add_option_function<std::string>("--isa", force_isa, "Instruction set of the evaluation [the machine's best]")
      ->type_name("NAME")
      ->check(one_of({"sse2", "avx2", "avx512"}))
      ->group(group);
}

Status with_threads(int threads, const std::function<Status()>& work) {
  if (threads == 0) return work();
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  Status status;
  arena.execute([&] { status = work(); });
  return status;
}

void add_seconds(Json& object, const CommonOptions& options, const Timings& timings) {
  if (options.timings) object["seconds"] = timings.as_json();
}

}  // namespace tessera::cli
