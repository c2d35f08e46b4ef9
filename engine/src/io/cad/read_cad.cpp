// CAD files, by the program tessera-cad-reader.

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <string_view>
#include <system_error>

#include "io/cad/cad_reader.h"
#include "io/file/file.h"
#include "tessera/cad.h"
#include "tessera/guard.h"
#include "tessera/io.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

namespace fs = std::filesystem;

/// The part of path.native() that path.extension() copies, which takes memory.
std::string_view extension_of(const fs::path& path) {
  std::string_view name = path.native();
  name.remove_prefix(name.rfind('/') + 1);  // 0 if there is no '/'
  const std::size_t dot = name.rfind('.');
  return dot == 0 || dot == std::string_view::npos ? std::string_view() : name.substr(dot);
}

/// The reader's name of the format; empty if the extension is of no CAD file.
std::string_view format_of(const fs::path& path, CadFormat stated) {
  if (stated == CadFormat::step) return "STEP";
  if (stated == CadFormat::iges) return "IGES";
  if (stated == CadFormat::brep) return "BREP";
  const std::string_view extension = extension_of(path);
  const auto same = [](char c, char small) { return c == small || (c >= 'A' && c <= 'Z' && c - 'A' + 'a' == small); };
  for (const CadExtension& known : cad_extensions)
    if (std::ranges::equal(extension, known.extension, same)) return known.format;
  return {};
}

/// The size of the file, if it can be read.
Result<std::uintmax_t> readable_size(const fs::path& path) {
  std::error_code error;
  const fs::file_status facts = fs::status(path, error);
  if (fs::is_directory(facts)) return Status(StatusCode::io_error, path.string() + ": is a directory, not a file");
  // Must be a regular file, because it is read twice: a pipe would end, or block whoever opens it.
  if (fs::exists(facts) && !fs::is_regular_file(facts))
    return Status(StatusCode::unsupported, path.string() + ": CAD files are read from regular files only");
  if (!std::ifstream(path, std::ios::binary)) return io_failure(path, "cannot be opened", errno);
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) return io_failure(path, "cannot be read", error.value());
  if (size == 0) return Status(StatusCode::parse_error, path.string() + ": the file is empty");
  return size;
}

Result<Model> read(const fs::path& path, const CadOptions& options) {
  const std::string_view format = format_of(path, options.format);
  if (format.empty())
    return Status(StatusCode::unsupported, path.string() + ": unsupported format \"" + lower_extension(path) +
                                               "\": CAD files are read as " + listed_cad_extensions().substr(2));
  const Result<std::uintmax_t> size = readable_size(path);
  if (!size) return size.status();
  const Result<std::string> reader = reader_for(options.reader, format);
  if (!reader) return Status(reader.status().code(), path.string() + ": " + reader.status().message());
  Result<Model> model = run_cad_reader({*reader, format, path.string(), *size, options.cancel});
  if (model) model->name = path.stem().string();
  return model;
}

}  // namespace

bool is_cad_file(const fs::path& path) { return !format_of(path, CadFormat::by_extension).empty(); }

Result<Model> read_cad(const fs::path& path, const CadOptions& options) {
  return guarded([&] { return read(path, options); });
}

}}  // namespace tessera::abi_0_1
