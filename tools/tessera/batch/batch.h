#pragma once
// Many files, listed in a file: worker processes, each file under its limits, and a record of what is done.

#include <functional>
#include <string>
#include <vector>

#include "batch/jobs.h"
#include "console/timings.h"
#include "line/arguments.h"
#include "line/command_line.h"
#include "tessera/status.h"

namespace tessera::cli {

/// Adds --list, --shard, --resume, --keep-going, --timeout and --memory-per-file. With --list, MODEL need not be there.
void add_batch(Command& command, BatchOptions& options);

/// Returns the files that the list names, of all shards. It skips empty lines and lines that begin with #. Throws
/// UsageError if there are neither `files` (of the option MODEL) nor a list, or if the list cannot be read.
std::vector<std::string> listed_files(const BatchOptions& options, const std::vector<std::string>& files);

/// Throws UsageError if a list's files would share one output.
void check_batch(const BatchOptions& options, const Plan& plan);

/// The words of a command line that its results depend on: without the options above, --threads and --timings.
std::vector<std::string> result_words(int argc, const char* const* argv);

/// Does `work` for each job of the shard, every N-th from the K-th on, in worker processes: as many as `threads` says,
/// each with one thread. The output of a job appears as a whole. A worker that takes too long, or ends, is replaced;
/// its file has failed.
///
/// Beside the list lies the record of the shard, LIST.K-of-N.done: a line for each file that is done, with a hash of
/// its bytes, the options and the version. With --resume these are passed over if their outputs exist. Workers compute
/// the hashes, within the limits of the file. Call it before any thread is started.
Status run_batch(const Plan& plan, const CommonOptions& options,
                 const std::function<Status(const Job&, Timings&)>& work);

}  // namespace tessera::cli
