#include "io/file/relative_path.h"
#include "io/file/text_cursor.h"

#include <algorithm>
#include <charconv>
#include <system_error>

#include "tessera/io.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

namespace fs = std::filesystem;

}  // namespace

Result<fs::path> path_beside(std::string_view file, std::string_view relative) {
  if (relative.empty() || relative.find('\0') != std::string_view::npos)
    return Status(StatusCode::parse_error, "expected the name of a file, found " + quote(relative));
  const fs::path path(relative);
  const bool is_url = relative.find("://") != std::string_view::npos;
  if (path.is_absolute() || is_url || std::find(path.begin(), path.end(), "..") != path.end())
    return Status(StatusCode::unsupported, quote(relative) +
                                               " is not read: the path must be relative to this file, without ..; put "
                                               "the file beside this one or below");
  return (fs::path(file).parent_path() / path).lexically_normal();
}

Status check_below(std::string_view file, const fs::path& path) {
  std::error_code error;
  const fs::path parent = fs::path(file).parent_path();
  const fs::path folder = fs::canonical(parent.empty() ? fs::path(".") : parent, error);
  const fs::path place = error ? fs::path() : fs::canonical(path, error);
  if (error) return {};  // whoever opens the file says what is wrong
  const auto [rest, unused] = std::mismatch(folder.begin(), folder.end(), place.begin(), place.end());
  if (rest == folder.end()) return {};
  return {StatusCode::unsupported, quote(path.string()) + " is not read: it is a link to " + quote(place.string()) +
                                       ", outside of the folder " + quote(folder.string())};
}

Result<std::string> read_regular_file(const fs::path& path) {
  std::error_code error;
  if (fs::exists(path, error) && !fs::is_regular_file(path, error))
    return Status(StatusCode::io_error, path.string() + ": is not a regular file");
  return read_file(path);
}

Result<std::string> percent_decoded(std::string_view uri) {
  std::string text;
  for (std::size_t k = 0; k < uri.size(); ++k) {
    if (uri[k] != '%') {
      text += uri[k];
      continue;
    }
    unsigned byte = 0;
    const std::string_view digits = uri.substr(k + 1, 2);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), byte, 16);
    if (error != std::errc() || digits.size() != 2 || end != digits.data() + 2)
      return Status(StatusCode::parse_error, "expected two hexadecimal digits after %, found " + quote(digits));
    text += static_cast<char>(byte);
    k += 2;
  }
  return text;
}

}}  // namespace tessera::abi_0_1
