// tessera man: the manual page.

#include <memory>

#include "commands/commands.h"
#include "line/arguments.h"
#include "line/man_page.h"
#include "tessera/version.h"

namespace tessera::cli {

void add_man(Command& tool, Session& session) {
  Command& command = tool.add_command("man", "Print the manual page");
  const auto output = std::make_shared<std::string>();
  add_text_output(command, *output);
  command.footer = "Example:\n  tessera man | man -l -";
  command.choose = [output, &tool, &session] {
    session.command = [output, &tool] { return write_text(man_page(tool, TESSERA_VERSION), *output); };
  };
}

}  // namespace tessera::cli
