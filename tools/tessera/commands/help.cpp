// tessera help: the help of the tool or of a command.

#include <memory>

#include "commands/commands.h"
#include "console/console.h"
#include "line/arguments.h"
#include "line/help.h"
#include "line/suggestions.h"

namespace tessera::cli {

void add_help(Command& tool, Session& session) {
  Command& command = tool.add_command("help", "Print the help of a command");
  const auto name = std::make_shared<std::string>();
  const auto output = std::make_shared<std::string>();
  command.add_text("COMMAND", "NAME", "The command [all of them, in short]", *name);
  add_text_output(command, *output);
  command.footer = "Example:\n  tessera help raycast";
  command.choose = [name, output, &tool, &session] {
    const Command* const about = name->empty() ? &tool : tool.find(*name);
    if (!about) throw UsageError("there is no command " + *name + did_you_mean(*name, tool.command_names()));
    session.command = [about, output, &tool] { return write_text(help_text(tool, *about), *output); };
  };
}

}  // namespace tessera::cli
