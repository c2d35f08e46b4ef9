// Stands for file.cpp and posix_output.cpp in builds without files.

#include <string>

#include "io/file/file.h"
#include "io/file/output_file.h"
#include "io/file/output_place.h"
#include "tessera/guard.h"
#include "tessera/io.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

Status no_files(const std::filesystem::path& path, const char* what) {
  return Status(StatusCode::unsupported, path.string() + ": " + what);
}

Status no_reading(const std::filesystem::path& path) {
  return no_files(path, "this build of Tessera reads no files; give it the file's bytes instead");
}

constexpr const char* no_writing = "this build of Tessera writes no files; take the file's bytes instead";

}  // namespace

Result<std::string> read_file(const std::filesystem::path& path) {
  return guarded([&]() -> Result<std::string> { return no_reading(path); });
}
Result<FileBytes> read_file_bytes(const std::filesystem::path& path) {
  return guarded([&]() -> Result<FileBytes> { return no_reading(path); });
}

void remove_temporaries() noexcept {}

Result<OpenedPlace> open_place(const std::filesystem::path& path) { return no_files(path, no_writing); }
Result<OpenedPlace> open_standard_output() { return no_files("standard output", no_writing); }

}}  // namespace tessera::abi_0_1
