#pragma once
// The help of the tool, and messages for a command line that it does not understand.

#include <string>

namespace CLI {
class App;
class Error;
}  // namespace CLI

namespace tessera::cli {

/// Name, version and closing words of `tessera --help`.
void describe(CLI::App& app);

/// The message for a wrong command line. It names words that are no option or command first, with a suggestion.
std::string usage_fault(const CLI::App& app, const CLI::Error& error);
/// The message for a command line without a command.
std::string missing_command(const CLI::App& app);

}  // namespace tessera::cli
