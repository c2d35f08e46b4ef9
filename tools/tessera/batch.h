#pragma once
// Many files, listed in a file: worker processes, each file under its limits, and a record of what is done.

#include <functional>
#include <string>
#include <vector>

#include "arguments.h"
#include "command_line.h"
#include "jobs.h"
#include "tessera/status.h"
#include "timings.h"

namespace tessera::cli {

/// Adds --list, --shard, --resume, --keep-going, --timeout and --memory-per-file. With --list, `files` (of the option
/// MODEL) need not be there.
void add_batch(Command& command, BatchOptions& options);

/// Appends the files that the list names and that belong to the shard: every N-th, from the K-th on. Empty lines and
/// those that begin with # are left out. Throws UsageError if there are neither files nor a list, or the list cannot be
/// read.
void append_listed(const BatchOptions& options, std::vector<std::string>& files);

/// Throws UsageError if a list's files would share one output.
void check_batch(const BatchOptions& options, const Plan& plan);

/// The words of a command line that its results depend on: without the options above, --threads and --timings.
std::vector<std::string> result_words(int argc, const char* const* argv);

/// Does `work` for each job in worker processes, as many as `threads` says, each with one thread. What a job prints
/// appears as a whole. A worker that takes too long, or ends, is replaced; its file has failed.
///
/// Beside the list lies the record of the shard, LIST.K-of-N.done: a line for each file that is done, with a hash of its
/// bytes, the options and the version. With --resume these are passed over if their outputs exist. Call it before any
/// thread is started.
Status run_batch(const Plan& plan, const CommonOptions& options,
                 const std::function<Status(const Job&, Timings&)>& work);

}  // namespace tessera::cli
