// tessera completion: the script that completes the command line in a shell.

#include <memory>

#include "arguments.h"
#include "commands.h"
#include "completion.h"

namespace tessera::cli {

void add_completion(CLI::App& app, Session& session) {
  CLI::App* const command = app.add_subcommand("completion", "Print the script that completes commands in a shell");
  const auto shell = std::make_shared<std::string>();
  command->add_option("SHELL", *shell, "The shell")
      ->required()
      ->type_name("NAME")
      ->check(one_of({"bash", "zsh", "fish"}));
  const auto output = std::make_shared<std::string>();
  add_text_output(*command, *output);
  command->footer(
      "Packages install the scripts where the shells look for them. Without them:\n"
      "\nExamples:\n"
      "  eval \"$(tessera completion bash)\"                                       # in ~/.bashrc\n"
      "  source <(tessera completion zsh)                                        # in ~/.zshrc, after compinit\n"
      "  tessera completion fish -o ~/.config/fish/completions/tessera.fish");
  command->callback([shell, output, &app, &session] {
    session.command = [shell, output, &app] {
      const CommandText tool = command_text(app);
      const std::string script = *shell == "bash"  ? bash_completion(tool)
                                 : *shell == "zsh" ? zsh_completion(tool)
                                                   : fish_completion(tool);
      return write_text(script, *output);
    };
  });
}

}  // namespace tessera::cli
