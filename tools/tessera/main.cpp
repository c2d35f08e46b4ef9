// The command line: surfaces in, points, meshes, pictures and ray hits out.

#include <exception>

#include "batch/batch.h"
#include "commands/commands.h"
#include "console/console.h"
#include "console/output.h"
#include "line/help.h"
#include "line/suggestions.h"
#include "tessera/execution.h"

namespace tessera::cli { namespace {

constexpr int success = 0, bad_input = 1, bad_command_line = 2;
constexpr const char* hint = "\nTry tessera --help, or tessera help COMMAND.";

void add_commands(Command& tool, Session& session) {
  add_info(tool, session);
  add_eval(tool, session);
  add_tessellate(tool, session);
  add_raycast(tool, session);
  add_convert(tool, session);
  add_project(tool, session);
  add_section(tool, session);
  add_check(tool, session);
  add_compare(tool, session);
  add_measure(tool, session);
  add_view(tool, session);
  add_completion(tool, session);
  add_man(tool, session);
  add_help(tool, session);
}

int print_text(const std::string& text) {
  const Status printed = print(text);
  if (!printed.ok()) complain(printed.message());
  return printed.ok() ? success : bad_input;
}

int run_command(const Session& session) {
  if (const Result<Isa> isa = default_isa(); !isa) {
    complain(isa.status().message());
    return bad_command_line;
  }
  catch_signals();
  // Worker processes are made before there are threads, and have one each.
  const int threads = session.common.batch.list.empty() ? session.common.threads : 0;
  const Status status = with_threads(threads, session.command);
  if (!status.ok() && status.code() != StatusCode::cancelled && !is_already_said(status)) complain(status.message());
  remove_empty_folders();
  end_by_signal();
  return status.ok() ? success : bad_input;
}

int run(int argc, char** argv) {
  Command tool;
  Session session;
  bool version = false;
  describe(tool);
  tool.add_flag("--version",
                "Print the version, the formats that are read and written, and the CAD reader that is found", version);
  tool.add_help();
  add_commands(tool, session);
  session.common.words = result_words(argc, argv);
  Parsed parsed;
  try {
    parsed = parse(tool, argc, argv);
  } catch (const UsageError& error) {
    complain(error.what() + std::string(hint));
    return bad_command_line;
  }
  if (parsed.help) return print_text(help_text(tool, parsed.command ? *parsed.command : tool));
  if (version) return print_text(version_text());
  if (session.command) return run_command(session);
  complain("expected a command (" + listed(tool.command_names(), "or") + "), found none" + hint);
  return bad_command_line;
}

}}  // namespace tessera::cli

int main(int argc, char** argv) {
  try {
    return tessera::cli::run(argc, argv);
  } catch (const std::exception& error) {
    tessera::cli::complain(error.what());
    return tessera::cli::bad_input;
  }
}
