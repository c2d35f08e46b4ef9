#pragma once
// The help of the tool, and messages for a wrong command line.

#include <string>

namespace CLI {
class App;
class Error;
}  // namespace CLI

namespace tessera::cli {

/// Sets name, version and closing words of `tessera --help`.
void describe(CLI::App& app);

/// The message for a wrong command line. Names unknown options and commands first, with a suggestion.
std::string usage_fault(const CLI::App& app, const CLI::Error& error);
/// The message for a command line without a command.
std::string missing_command(const CLI::App& app);

}  // namespace tessera::cli
