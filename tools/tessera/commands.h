#pragma once
// The commands of the tool. Each adds its options to the command line, and itself to the session if it is chosen.

#include <CLI/CLI.hpp>
#include <functional>

#include "common_options.h"
#include "tessera/status.h"

namespace tessera::cli {

/// The command that the user has chosen.
struct Session {
  std::function<Status()> command;
  CommonOptions common;
};

void add_info(CLI::App& app, Session& session);
void add_eval(CLI::App& app, Session& session);
void add_tessellate(CLI::App& app, Session& session);
void add_raycast(CLI::App& app, Session& session);
void add_convert(CLI::App& app, Session& session);
void add_check(CLI::App& app, Session& session);
void add_completion(CLI::App& app, Session& session);
void add_man(CLI::App& app, Session& session);

}  // namespace tessera::cli
