#pragma once
// Options that every command has.

#include <functional>

#include "command_line.h"
#include "tessera/status.h"
#include "timings.h"

namespace tessera::cli {

struct CommonOptions {
  bool json = false, timings = false;
  int threads = 0;  ///< 0: as many as the machine has
};

/// Adds --json, --timings, --threads and --isa.
void add_common(Command& command, CommonOptions& options);

/// Runs `work` in an arena of `threads` threads.
Status with_threads(int threads, const std::function<Status()>& work);

/// Adds {"seconds": ...} if --timings is set.
void add_seconds(Json& object, const CommonOptions& options, const Timings& timings);

}  // namespace tessera::cli
