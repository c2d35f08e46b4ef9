// The command line: surfaces in, points, meshes, pictures and ray hits out.

#include <cstdio>
#include <exception>
#include <sstream>

#include "commands.h"
#include "console.h"
#include "tessera/execution.h"
#include "usage.h"

namespace tessera::cli {
namespace {

constexpr int success = 0, bad_input = 1, bad_command_line = 2;

void add_commands(CLI::App& app, Session& session) {
  add_info(app, session);
  add_eval(app, session);
  add_tessellate(app, session);
  add_raycast(app, session);
  add_convert(app, session);
  add_check(app, session);
  add_completion(app, session);
  add_man(app, session);
}

/// Prints help and version on standard output, faults on standard error.
int end_of_parsing(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() != 0) {
    complain(usage_fault(app, error));
    return bad_command_line;
  }
  std::ostringstream output, errors;
  (void)app.exit(error, output, errors);
  const Status printed = print(output.str());
  if (printed.ok()) return success;
  complain(printed.message());
  return bad_input;
}

int run(int argc, char** argv) {
  CLI::App app("Tessera turns parametric surfaces into points, meshes, pictures and ray hits", "tessera");
  Session session;
  describe(app);
  add_commands(app, session);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return end_of_parsing(app, error);
  }
  if (!session.command) {
    complain(missing_command(app));
    return bad_command_line;
  }
  if (const Result<Isa> isa = default_isa(); !isa) {
    complain(isa.status().message());
    return bad_command_line;
  }
  catch_signals();
  const Status status = with_threads(session.common.threads, session.command);
  if (!status.ok() && status.code() != StatusCode::cancelled && !is_already_said(status)) complain(status.message());
  end_by_signal();
  return status.ok() ? success : bad_input;
}

}  // namespace
}  // namespace tessera::cli

int main(int argc, char** argv) {
  try {
    return tessera::cli::run(argc, argv);
  } catch (const std::exception& error) {
    tessera::cli::complain(error.what());
    return tessera::cli::bad_input;
  }
}
