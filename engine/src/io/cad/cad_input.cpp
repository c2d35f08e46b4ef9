#include "io/cad/cad_input.h"

#include <array>
#include <cerrno>
#include <fstream>
#include <system_error>

#include "io/file/file.h"
#include "io/file/gzip.h"
#include "io/file/zip.h"
#include "tessera/io.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

namespace fs = std::filesystem;

Status no_bytes(const std::string& name) { return Status(StatusCode::parse_error, name + ": the file is empty"); }

/// Whether a file of this name that begins with these bytes is packed.
bool is_packed(const fs::path& name, std::string_view begin) {
  return lower_extension(name) == ".gz" || begins_as_gzip(begin) || begins_as_zip(begin);
}

}  // namespace

Result<CadInput> CadInput::open(const fs::path& path) {
  CadInput made(path);
  std::error_code error;
  const fs::file_status facts = fs::status(path, error);
  if (fs::is_directory(facts)) return Status(StatusCode::io_error, made.name_ + ": is a directory, not a file");
  // Must be a regular file, because it is read twice: a pipe would end, or block whoever opens it.
  if (fs::exists(facts) && !fs::is_regular_file(facts))
    return Status(StatusCode::unsupported, made.name_ + ": CAD files are read from regular files only");
  std::ifstream file;
  file.rdbuf()->pubsetbuf(nullptr, 0);  // no buffer for four bytes
  file.open(path, std::ios::binary);
  if (!file) return io_failure(path, "cannot be opened", errno);
  made.size_ = fs::file_size(path, error);
  if (error) return io_failure(path, "cannot be read", error.value());
  if (made.size_ == 0) return no_bytes(made.name_);
  std::array<char, 4> begin{};
  file.read(begin.data(), begin.size());
  made.is_file_ = !is_packed(path, {begin.data(), static_cast<std::size_t>(file.gcount())});
  if (made.is_file_) return made;
  const Result<std::string> bytes = read_file(path);
  if (!bytes) return bytes.status();
  if (Status status = made.unpack(*bytes); !status.ok()) return status;
  return made;
}

Result<CadInput> CadInput::memory(std::string_view bytes, const fs::path& name) {
  CadInput made(name);
  if (bytes.empty()) return no_bytes(made.name_);
  made.size_ = bytes.size();
  if (!is_packed(name, bytes))
    made.given_ = bytes;
  else if (Status status = made.unpack(bytes); !status.ok())
    return status;
  return made;
}

Status CadInput::unpack(std::string_view bytes) {
  Result<std::string> unpacked = begins_as_zip(bytes) ? unpack_zip(bytes, name_) : unpack_gzip(bytes, name_);
  if (!unpacked) return unpacked.status();
  owned_ = *std::move(unpacked);
  size_ = owned_.size();
  return {};
}

Result<std::string_view> CadInput::bytes() {
  if (!given_.empty()) return given_;
  if (owned_.empty()) {
    Result<std::string> read = read_file(name_);
    if (!read) return read.status();
    owned_ = *std::move(read);
  }
  return std::string_view(owned_);
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
