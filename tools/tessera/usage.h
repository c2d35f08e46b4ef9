#pragma once
// What the tool says of itself, and of a command line that it does not understand.

#include <string>

namespace CLI {
class App;
class Error;
}  // namespace CLI

namespace tessera::cli {

/// Name, version and closing words of `tessera --help`.
void describe(CLI::App& app);

/// What is wrong: words that are no option or no command first, with what may have been meant.
std::string usage_fault(const CLI::App& app, const CLI::Error& error);
/// The same of a command line without a command.
std::string missing_command(const CLI::App& app);

}  // namespace tessera::cli
