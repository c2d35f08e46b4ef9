#include "console/output.h"

#include <filesystem>
#include <system_error>

#include "console/console.h"

namespace tessera::cli {
namespace {

namespace fs = std::filesystem;

/// The folders that this process has made, each after the one it lies in.
std::vector<fs::path>& made_folders() {
  static std::vector<fs::path> folders;
  return folders;
}

Status make_folders(const fs::path& folder) {
  std::error_code error;
  if (folder.empty() || fs::exists(fs::symlink_status(folder, error))) return {};
  if (Status status = make_folders(folder.parent_path()); !status.ok()) return status;
  if (fs::create_directory(folder, error)) made_folders().push_back(folder);
  if (!error) return {};
  return Status(StatusCode::io_error, "the folder " + folder.string() + " cannot be made: " + error.message());
}

}  // namespace

Result<OutputFile> open_output(const std::string& path, bool writes) {
  if (!writes) return OutputFile::make("/dev/null");
  if (path.empty() || is_stream(path)) return OutputFile::standard_output(&interrupted());
  if (Status status = make_folders(fs::path(path).parent_path()); !status.ok())
    return Status(status.code(), path + ": cannot be written: " + status.message());
  return OutputFile::make(path, &interrupted());
}

void remove_empty_folders() {
  std::vector<fs::path>& folders = made_folders();
  std::error_code ignored;  // a folder that is not empty stays
  for (; !folders.empty(); folders.pop_back()) fs::remove(folders.back(), ignored);
}

bool is_stream(const std::string& output) { return output == stream_name; }

std::string format_path(const std::string& output, const std::string& format) {
  return is_stream(output) ? "standard output." + format : output;
}

void add_stream_format(Command& command, const std::vector<std::string>& formats, std::string& format) {
  command.add_choice("--format", formats, "Format of standard output, for -o -",
                     [&format](const std::string& name) { format = name; });
}

void check_stream_format(const std::string& output, const std::string& format) {
  if (is_stream(output) && format.empty()) throw UsageError("--output", "- needs --format NAME");
  if (!is_stream(output) && !format.empty())
    throw UsageError("--format", "is for -o - only; the extension of " + output + " decides its format");
}

}  // namespace tessera::cli
