#pragma once
// Worker processes: copies of this one that do jobs one after the other.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "tessera/status.h"

namespace tessera::cli {

struct WorkerLimits {
  std::size_t workers = 1;
  double timeout = 0;        ///< seconds for one job; 0: none
  std::uint64_t memory = 0;  ///< bytes of a worker's address space beyond what it has; 0: no limit
};

/// The outcome of a job.
struct JobResult {
  Status status;
  std::string output;      ///< what it has printed
  std::string note;        ///< what the work has noted for done()
  bool has_ended = false;  ///< whether the worker has ended, so that the status does not name the file
};

/// Starts workers and gives them the jobs that next() names, until it names none. `work` runs in a worker, with one
/// thread; it may write a note. `done` runs here, one call for each job. A worker that takes too long gets a request to
/// terminate, then is killed; the status of its job is cancelled; that of one that ended by itself is internal. Both
/// are replaced. Workers do not outlive this process.
///
/// Needs a process without threads. Errors: io_error (no process or pipe could be made), cancelled (by an interrupt;
/// all workers have ended).
Status run_workers(const WorkerLimits& limits, const std::function<std::optional<std::size_t>()>& next,
                   const std::function<Status(std::size_t job, std::string& note)>& work,
                   const std::function<void(std::size_t job, const JobResult&)>& done);

}  // namespace tessera::cli
