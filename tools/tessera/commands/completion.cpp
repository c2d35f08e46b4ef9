// tessera completion: the script that completes the command line in a shell.

#include <memory>

#include "commands/commands.h"
#include "line/arguments.h"
#include "line/completion.h"

namespace tessera::cli {

void add_completion(Command& tool, Session& session) {
  Command& command = tool.add_command("completion", "Print the script that completes commands in a shell");
  const auto shell = std::make_shared<std::string>();
  command.add_choice("SHELL", {"bash", "zsh", "fish"}, "The shell", [shell](const std::string& name) { *shell = name; })
      .require();
  const auto output = std::make_shared<std::string>();
  add_text_output(command, *output);
  command.footer =
      "Packages install the scripts where the shells look for them. Without them:\n"
      "\nExamples:\n"
      "  eval \"$(tessera completion bash)\"                                       # in ~/.bashrc\n"
      "  source <(tessera completion zsh)                                        # in ~/.zshrc, after compinit\n"
      "  tessera completion fish -o ~/.config/fish/completions/tessera.fish";
  command.choose = [shell, output, &tool, &session] {
    session.command = [shell, output, &tool] {
      const std::string script = *shell == "bash"  ? bash_completion(tool)
                                 : *shell == "zsh" ? zsh_completion(tool)
                                                   : fish_completion(tool);
      return write_text(script, *output);
    };
  };
}

}  // namespace tessera::cli
