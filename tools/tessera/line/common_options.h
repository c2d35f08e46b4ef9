#pragma once
// Options that every command has.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "line/command_line.h"
#include "tessera/status.h"

namespace tessera::cli {

/// One part of N.
struct Shard {
  int first = 1, second = 1;  ///< K and N
};
/// Parses "K/N". Throws UsageError.
Shard parse_shard(const std::string& text);

/// Many files, listed in a file; see batch.h.
struct BatchOptions {
  std::string list;  ///< empty: no batch
  Shard shard;
  bool resume = false, keep_going = false;
  double timeout = 0;        ///< seconds; 0: none
  std::uint64_t memory = 0;  ///< bytes; 0: no limit
};

struct CommonOptions {
  bool json = false, timings = false;
  int threads = 0;  ///< 0: as many as the machine has
  BatchOptions batch;
  std::vector<std::string> words;  ///< the command line, without what does not change results
};

/// Adds --json, --timings, --threads and --isa.
void add_common(Command& command, CommonOptions& options);

/// Runs `work` in an arena of `threads` threads.
Status with_threads(int threads, const std::function<Status()>& work);

}  // namespace tessera::cli
