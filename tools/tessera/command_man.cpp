// tessera man: the manual page.

#include <memory>

#include "arguments.h"
#include "commands.h"
#include "man_page.h"
#include "tessera/version.h"

namespace tessera::cli {

void add_man(CLI::App& app, Session& session) {
  CLI::App* const command = app.add_subcommand("man", "Print the manual page");
  const auto output = std::make_shared<std::string>();
  add_text_output(*command, *output);
  command->footer("Example:\n  tessera man | man -l -");
  command->callback([output, &app, &session] {
    session.command = [output, &app] { return write_text(man_page(command_text(app), TESSERA_VERSION), *output); };
  });
}

}  // namespace tessera::cli
