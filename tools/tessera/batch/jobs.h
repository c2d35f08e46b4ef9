#pragma once
// Turns the file names on the command line into jobs: groups of files, each with the place of its result.

#include <functional>
#include <string>
#include <vector>

#include "console/timings.h"
#include "line/common_options.h"
#include "tessera/status.h"

namespace tessera::cli {

/// Files that make one result.
struct Job {
  std::vector<std::string> inputs;  ///< at least one
  std::string output;               ///< empty: standard output
};

struct Plan {
  std::vector<Job> jobs;
  std::vector<std::string> unmatched;  ///< patterns that match no file

  std::vector<std::string> outputs() const;  ///< of each job
};

/// How a command treats its files.
struct OutputRule {
  std::string option;     ///< that names the output, for messages
  std::string extension;  ///< the extension of a file in a folder: ".png"
  bool together = true;   ///< whether several files without an output make one result
};

/// The files that `words` name. A name with *, ? or [ that is not a file stands for the files that it matches, in the
/// order of their bytes; if there are none, running the jobs reports an error. Names of `listed` are no patterns, and
/// follow. If the output is a folder, or holds {name} (the file's name without folder and extension), each file has its
/// own result; otherwise all files make one. Throws UsageError if two files would be written to one place.
Plan plan_jobs(const std::vector<std::string>& words, const std::string& output, const OutputRule& rule,
               const std::vector<std::string>& listed = {});

/// Whether an output is a folder, which gets a result per file.
bool is_folder(const std::string& output);

/// The output of --json for a job that failed.
Json error_json(const Job& job, const Status& status);

/// Does `work` for each job, in worker processes if the files come from a list (see batch.h). Reports jobs that fail
/// and continues; the status is then not ok, and already printed. With --json a failure is also an object {"files",
/// "error"}; with --timings standard error shows the timings.
Status run_jobs(const Plan& plan, const CommonOptions& options,
                const std::function<Status(const Job&, Timings&)>& work);

}  // namespace tessera::cli
