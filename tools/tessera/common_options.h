#pragma once
// Options that every command has.

#include <functional>

#include "tessera/status.h"
#include "timings.h"

namespace CLI {
class App;
}

namespace tessera::cli {

struct CommonOptions {
  bool json = false, timings = false;
  int threads = 0;  ///< 0: as many as the machine has
};

/// --json, --timings, --threads and --isa.
void add_common(CLI::App& command, CommonOptions& options);

/// Runs `work` in an arena of so many threads.
Status with_threads(int threads, const std::function<Status()>& work);

/// Adds {"seconds": ...} where --timings asks for it.
void add_seconds(Json& object, const CommonOptions& options, const Timings& timings);

}  // namespace tessera::cli
