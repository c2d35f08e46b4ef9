// OpenCASCADE's own format.

#include <opencascade/BRepTools.hxx>
#include <opencascade/BRep_Builder.hxx>
#include <opencascade/BinTools.hxx>

#include <array>
#include <cerrno>
#include <fstream>
#include <string_view>

#include "io/file/file.h"
#include "io_occt/cad_file.h"

namespace tessera::inline abi_0_1 {
namespace {

constexpr std::string_view text_mark = "CASCADE Topology V", binary_mark = "Open CASCADE Topology V";

/// The first bytes of the file, in which its version is stated.
std::string begin_of(std::ifstream& file) {
  std::array<char, 4096> bytes;
  file.read(bytes.data(), bytes.size());
  const std::string begin(bytes.data(), static_cast<std::size_t>(file.gcount()));
  file.clear();
  file.seekg(0);
  return begin;
}

Status unreadable(const std::string& path, const std::string& why) {
  return Status(StatusCode::parse_error, path + ": OpenCASCADE cannot read it as BREP: " + why);
}

}  // namespace

Result<CadFile> load_brep(const std::string& path) {
  std::string failure;
  take_messages(failure);
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return io_failure(path, "cannot be opened", errno);
  const std::string begin = begin_of(stream);
  if (begin.find(text_mark) == std::string::npos)
    return Status(StatusCode::parse_error,
                  path + ": this is not BREP: it does not begin with \"" + std::string(text_mark) + "\"");
  CadFile file;
  try {
    // OpenCASCADE does not see that the stream fails: it would read on for ever, and accept what is not there.
    stream.exceptions(std::ios::failbit | std::ios::badbit);
    if (begin.starts_with(binary_mark) || begin.starts_with('\n' + std::string(binary_mark)))
      BinTools::Read(file.shape, stream);
    else
      BRepTools::Read(file.shape, stream, BRep_Builder());
  } catch (const std::ios::failure&) {
    return unreadable(path, "it ends too early, or text stands in the place of a number");
  }
  if (file.shape.IsNull()) return unreadable(path, failure.empty() ? "it holds no shape" : failure);
  return file;
}

}  // namespace tessera::inline abi_0_1
