#include "console/standard_input.h"
#include "io/file/output_file.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include "tessera/io.h"

namespace tessera::cli {
namespace {
constexpr const char* stem = "standard input";
}

Result<StandardInput> StandardInput::make(const std::string& format) {
  const Result<std::string> bytes = read_file("/dev/stdin");
  if (!bytes) return Status(bytes.status().code(), std::string(stem) + bytes.status().message().substr(10));
  std::error_code error;
  std::string folder = (std::filesystem::temp_directory_path(error) / "tessera-XXXXXX").string();
  if (error || !::mkdtemp(folder.data()))
    return Status(StatusCode::io_error, folder + ": cannot be made: " + std::strerror(errno));
  StandardInput made;
  made.folder_ = folder;
  made.path_ = folder + "/" + stem + "." + format;
  Result<OutputFile> copy = OutputFile::make(made.path_);
  if (!copy) return copy.status();
  copy->write(*bytes);
  if (Status status = copy->commit(); !status.ok()) return status;
  return made;
}

StandardInput::StandardInput(StandardInput&& other) noexcept
    : folder_(std::exchange(other.folder_, {})), path_(std::move(other.path_)) {}

StandardInput::~StandardInput() {
  std::error_code ignored;
  if (!folder_.empty()) std::filesystem::remove_all(folder_, ignored);
}

std::string StandardInput::renamed(const std::string& message) const {
  std::string text = message;
  for (std::size_t at = text.find(path_); at != std::string::npos; at = text.find(path_, at))
    text.replace(at, path_.size(), stem);
  return text;
}

}  // namespace tessera::cli
