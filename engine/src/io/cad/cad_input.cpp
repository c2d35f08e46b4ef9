#include "io/cad/cad_input.h"

#include "io/cad/kept_model.h"
#include "io/file/gzip.h"
#include "io/file/zip.h"
#include "tessera/io.h"

namespace tessera { inline namespace abi_0_1 {

Status CadInput::no_bytes() const { return Status(StatusCode::parse_error, name_ + ": the file is empty"); }

bool CadInput::is_packed(std::string_view begin) const {
  if (begins_as_kept_model(begin)) return false;  // whatever the name
  return lower_extension(name_) == ".gz" || begins_as_gzip(begin) || begins_as_zip(begin);
}

bool CadInput::is_kept_model() const { return begins_as_kept_model(given_.empty() ? owned_ : given_); }

Result<CadInput> CadInput::memory(std::string_view bytes, const std::filesystem::path& name) {
  CadInput made(name);
  if (bytes.empty()) return made.no_bytes();
  made.size_ = bytes.size();
  if (!made.is_packed(bytes))
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
  if (!owned_.empty()) return std::string_view(owned_);
  if (read_.empty()) {
    Result<FileBytes> read = read_file_bytes(name_);
    if (!read) return read.status();
    read_ = *std::move(read);
  }
  return view_of(read_);
}

}}  // namespace tessera::abi_0_1
