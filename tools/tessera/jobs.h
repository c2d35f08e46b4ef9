#pragma once
// Turns the file names on the command line into jobs: which files belong together, and where the result goes.

#include <functional>
#include <string>
#include <vector>

#include "common_options.h"
#include "tessera/status.h"
#include "timings.h"

namespace tessera::cli {

/// Files that make one result.
struct Job {
  std::vector<std::string> inputs;  ///< one at least
  std::string output;               ///< empty: standard output
};

struct Plan {
  std::vector<Job> jobs;
  std::vector<std::string> unmatched;  ///< patterns that match no file
};

/// How a command takes its files.
struct OutputRule {
  std::string option;     ///< that names the output, for messages
  std::string extension;  ///< the extension of a file in a folder: ".png"
  bool together = true;   ///< several files without an output make one result
};

/// The files that `words` name: a name with *, ? or [ that is no file stands for those that it matches, in the order of
/// their bytes; one that matches nothing is an
/// error when the jobs are run. An output that is a folder, or that holds {name},
/// gives each file a result of its own ({name}: the file's name without folder and extension); any other one takes them
/// all together. Throws CLI::ValidationError where two files would be written to one place.
Plan plan_jobs(const std::vector<std::string>& words, const std::string& output, const OutputRule& rule);

/// Whether an output is a folder, in which each file gets its result.
bool is_folder(const std::string& output);

/// Does `work` for each job and complains of those that fail, which do not stop the others: then the status is not ok,
/// and already said. With --json a failure is an object {"files", "error"} too; with --timings a line on standard error
/// tells them.
Status run_jobs(const Plan& plan, const CommonOptions& options,
                const std::function<Status(const Job&, Timings&)>& work);

}  // namespace tessera::cli
