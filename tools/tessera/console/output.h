#pragma once
// Outputs of commands: files whose folders are made, standard output, and their formats.

#include <string>
#include <string_view>
#include <vector>

#include "io/file/output_file.h"
#include "line/command_line.h"
#include "tessera/status.h"

namespace tessera::cli {

/// The name of standard input among models, and of standard output.
inline constexpr const char* stream_name = "-";

/// Opens the output file; missing folders are made. Standard output if `path` is empty or "-". After an interrupt the
/// file does not appear. Open it before the work, so that a wrong place is reported at once. A process that does not
/// write the results (`writes`) gets a file that keeps nothing. Errors: io_error.
Result<OutputFile> open_output(const std::string& path, bool writes = true);
/// Removes the folders that open_output() has made and that are still empty, as after a failure.
void remove_empty_folders();

/// Whether the output is standard output, so that reports must not go there.
bool is_stream(const std::string& output);
/// The path whose extension decides an output's format: "standard output.ply" for "-" and the format "ply".
std::string format_path(const std::string& output, const std::string& format);
/// Adds --format for outputs to "-": one of these words.
void add_stream_format(Command& command, const std::vector<std::string>& formats, std::string& format);
/// Throws UsageError if "-" has no format, or another output has one.
void check_stream_format(const std::string& output, const std::string& format);

}  // namespace tessera::cli
