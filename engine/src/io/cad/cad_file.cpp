// The files of a CadInput: the one that it opens, and the one that a child process can open.

#include <array>
#include <cerrno>
#include <fstream>
#include <system_error>

#include "io/cad/cad_input.h"
#include "io/cad/kept_model.h"
#include "io/file/file.h"
#include "tessera/io.h"

namespace tessera { inline namespace abi_0_1 {

namespace fs = std::filesystem;

Result<CadInput> CadInput::open(const fs::path& path) {
  CadInput made(path);
  std::error_code error;
  const fs::file_status facts = fs::status(path, error);
  if (fs::is_directory(facts)) return Status(StatusCode::io_error, made.name_ + ": is a directory, not a file");
  // Must be a regular file, because it is read twice: a pipe would end, or block whoever opens it.
  if (fs::exists(facts) && !fs::is_regular_file(facts))
    return Status(StatusCode::unsupported, made.name_ + ": CAD files are read from regular files only");
  std::ifstream file;
  file.rdbuf()->pubsetbuf(nullptr, 0);  // no buffer for a few bytes
  file.open(path, std::ios::binary);
  if (!file) return io_failure(path, "cannot be opened", errno);
  made.size_ = fs::file_size(path, error);
  if (error) return io_failure(path, "cannot be read", error.value());
  if (made.size_ == 0) return made.no_bytes();
  std::array<char, greeting_begin.size()> first{};
  file.read(first.data(), first.size());
  const std::string_view begin(first.data(), static_cast<std::size_t>(file.gcount()));
  const bool is_packed = made.is_packed(begin);
  made.is_file_ = !is_packed && !begins_as_kept_model(begin);
  if (made.is_file_) return made;
  Result<std::string> bytes = read_file(path);
  if (!bytes) return bytes.status();
  if (!is_packed) {
    made.owned_ = *std::move(bytes);
  } else if (Status status = made.unpack(*bytes); !status.ok()) {
    return status;
  }
  return made;
}

Result<std::string> CadInput::file() {
  if (is_file_) return name_;
  if (copy_.path().empty()) {
    const Result<std::string_view> content = bytes();
    if (!content) return content.status();
    Result<MemoryFile> copy = MemoryFile::make(*content, name_);
    if (!copy) return copy.status();
    copy_ = *std::move(copy);
  }
  return copy_.path();
}

}}  // namespace tessera::abi_0_1
