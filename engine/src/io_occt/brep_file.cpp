// OpenCASCADE's own format.

#include <opencascade/BRepTools.hxx>
#include <opencascade/BRep_Builder.hxx>
#include <opencascade/BinTools.hxx>
#include <opencascade/TopExp.hxx>
#include <opencascade/TopTools_IndexedMapOfShape.hxx>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <fstream>
#include <sstream>
#include <string_view>

#include "base/text.h"
#include "io/file/file.h"
#include "io_occt/cad_file.h"
#include "tessera/io.h"

namespace tessera { inline namespace abi_0_1 {
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

/// The lines that state a version of the text form. OpenCASCADE 7.6 knows a version by its whole line, whose end
/// changes with whoever writes it.
constexpr std::array<std::string_view, 3> known_lines{"CASCADE Topology V1, (c) Matra-Datavision",
                                                      "CASCADE Topology V2, (c) Matra-Datavision",
                                                      "CASCADE Topology V3, (c) Open Cascade"};

/// A line of the text, without what ends it.
std::string_view line_at(std::string_view text, std::size_t place) {
  text.remove_prefix(std::min(place, text.size()));
  return text.substr(0, text.find_first_of("\r\n"));
}

/// The version that a line states; 0 if it states none.
std::size_t version_of(std::string_view line) {
  std::size_t version = 0;
  line.remove_prefix(std::min(line.size(), text_mark.size()));
  std::from_chars(line.data(), line.data() + line.size(), version);
  return version;
}

/// "4 edges, 5 vertices".
std::string contents_of(const TopoDS_Shape& shape) {
  TopTools_IndexedMapOfShape edges, vertices;
  TopExp::MapShapes(shape, TopAbs_EDGE, edges);
  TopExp::MapShapes(shape, TopAbs_VERTEX, vertices);
  return counted(static_cast<std::size_t>(edges.Extent()), "edge") + ", " +
         counted(static_cast<std::size_t>(vertices.Extent()), "vertex", "vertices");
}

Status unreadable(const std::string& path, const std::string& why) {
  return Status(StatusCode::parse_error, path + ": OpenCASCADE cannot read it as BREP: " + why);
}

/// The text of a file with the line that OpenCASCADE knows its version by; empty if the file has it. `begin`: of the
/// file.
Result<std::string> with_known_line(const std::string& path, std::string_view begin) {
  const std::size_t place = begin.find(text_mark);
  const std::string_view line = line_at(begin, place);
  const std::size_t version = version_of(line);
  if (version < 1 || version > known_lines.size())
    return unreadable(path, "its version must be 1 to " + std::to_string(known_lines.size()) + ", found \"" +
                                std::string(line.substr(0, 80)) + '"');
  if (line == known_lines[version - 1]) return std::string();
  Result<std::string> text = read_file(path);
  if (text) text->replace(place, line.size(), known_lines[version - 1]);
  return text;
}

}  // namespace

Result<DescribedShape> load_brep(const std::string& path) {
  std::string failure;
  take_messages(failure);
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return io_failure(path, "cannot be opened", errno);
  const std::string begin = begin_of(stream);
  if (begin.find(text_mark) == std::string::npos)
    return Status(StatusCode::parse_error,
                  path + ": this is not BREP: it does not begin with \"" + std::string(text_mark) + "\"");
  const bool binary = begin.starts_with(binary_mark) || begin.starts_with('\n' + std::string(binary_mark));
  const Result<std::string> text = binary ? std::string() : with_known_line(path, begin);
  if (!text) return text.status();
  std::istringstream restated(*text);
  std::istream& source = text->empty() ? static_cast<std::istream&>(stream) : restated;
  DescribedShape file;
  try {
    // OpenCASCADE does not see that the stream fails: it would read on for ever, and accept what is not there.
    source.exceptions(std::ios::failbit | std::ios::badbit);
    if (binary)
      BinTools::Read(file.shape, source);
    else
      BRepTools::Read(file.shape, source, BRep_Builder());
  } catch (const std::ios::failure&) {
    return unreadable(path, "it ends too early, or text stands in the place of a number");
  }
  if (file.shape.IsNull()) return unreadable(path, failure.empty() ? "it holds no shape" : failure);
  file.contents = contents_of(file.shape);
  return file;
}

}}  // namespace tessera::abi_0_1
