#pragma once
// The commands of the tool. Each adds its options to the command line, and itself to the session if it is chosen.

#include <functional>
#include <memory>
#include <string>

#include "batch/jobs.h"
#include "batch/team.h"
#include "line/command_line.h"

namespace tessera::cli {

/// The command that the user has chosen.
struct Session {
  std::function<Status()> command;
  CommonOptions common;
  Team* team = nullptr;  ///< null: this process alone

  /// Chooses `work` on each job of a plan; a team ends each together.
  template <class Options>
  void choose(const Plan& plan, const std::shared_ptr<Options>& options,
              Status (*work)(const Job&, const Options&, const CommonOptions&, Timings&)) {
    command = [=, this] {
      return run_jobs(plan, common, [&](const Job& job, Timings& timings) {
        const Status own = work(job, *options, common, timings);
        return team ? team->end_job(own) : own;
      });
    };
  }
};

/// The text of `tessera --version`: the version, the formats that are read and written, and the CAD reader's place.
std::string version_text();
/// Sets name, purpose and closing words of `tessera --help`.
void describe(Command& tool);

void add_info(Command& tool, Session& session);
void add_eval(Command& tool, Session& session);
void add_tessellate(Command& tool, Session& session);
void add_raycast(Command& tool, Session& session);
void add_convert(Command& tool, Session& session);
void add_project(Command& tool, Session& session);
void add_section(Command& tool, Session& session);
void add_check(Command& tool, Session& session);
void add_compare(Command& tool, Session& session);
void add_measure(Command& tool, Session& session);
void add_view(Command& tool, Session& session);
void add_completion(Command& tool, Session& session);
void add_man(Command& tool, Session& session);
void add_help(Command& tool, Session& session);

}  // namespace tessera::cli
