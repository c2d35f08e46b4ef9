#include "io_occt/iges_sections.h"

#include <fstream>

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The letter of a line's section; 0 for a line that is too short.
char section_of(const std::string& line) {
  constexpr std::size_t column = 72;
  return line.size() > column ? line[column] : '\0';
}

}  // namespace

Status check_iges_sections(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string line;
  std::size_t number = 0;
  bool ended = false;
  while (!ended && std::getline(file, line)) {
    const char section = section_of(line);
    if (++number == 1 && (section == 'C' || section == 'B'))
      return Status(StatusCode::unsupported,
                    path + ": IGES in its " + (section == 'C' ? "compressed" : "binary") + " form is not read");
    if (number == 1 && section != 'S')
      return Status(StatusCode::parse_error, path + ":1: this is not IGES: the first line has no S in column 73");
    ended = section == 'T';
  }
  if (file.bad()) return Status(StatusCode::io_error, path + ": cannot be read");
  if (!ended)
    return Status(StatusCode::parse_error,
                  path + ":" + std::to_string(number) + ": the file ends before its section T: it is truncated");
  return {};
}

}}  // namespace tessera::abi_0_1
