// CAD files, by Tessera's own reader of STEP or the program tessera-cad-reader.

#include <algorithm>
#include <string_view>

#include "io/cad/cad_input.h"
#include "io/cad/cad_reader.h"
#include "io/cad/kept_model.h"
#include "io/file/gzip.h"
#include "io/step/read_step.h"
#include "tessera/cad.h"
#include "tessera/guard.h"
#include "tessera/io.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

namespace fs = std::filesystem;

/// The part of a file's name that path::extension() copies, which takes memory.
std::string_view extension_of(std::string_view name) {
  const std::size_t dot = name.rfind('.');
  return dot == 0 || dot == std::string_view::npos ? std::string_view() : name.substr(dot);
}

bool is_extension(std::string_view text, std::string_view extension) {
  const auto same = [](char c, char small) { return c == small || (c >= 'A' && c <= 'Z' && c - 'A' + 'a' == small); };
  return std::ranges::equal(text, extension, same);
}

/// The name of a format in messages, and to the program.
std::string_view name_of(CadFormat format) {
  if (format == CadFormat::step) return "STEP";
  return format == CadFormat::iges ? "IGES" : "BREP";
}

/// Reads by the program.
Result<Model> read_by_program(CadInput& input, CadFormat format, const CadOptions& options) {
  const Result<std::string> reader = reader_for(options.reader, name_of(format));
  if (!reader) return Status(reader.status().code(), input.name() + ": " + reader.status().message());
  const Result<std::string> file = input.file();
  if (!file) return file.status();
  return run_cad_reader({*reader, name_of(format), *file, input.name(), input.file_bytes(), options.cancel});
}

/// Reads STEP in this process.
Result<Model> read_by_tessera(CadInput& input, const CadOptions& options) {
  const Result<std::string_view> text = input.bytes();
  if (!text) return text.status();
  return read_step(*text, input.name(), {.cancel = options.cancel, .progress = options.progress});
}

/// Whether another reader may do better.
bool may_be_improved(const Result<Model>& read) {
  if (read) return !read->warnings.empty();
  return read.status().code() != StatusCode::cancelled && read.status().code() != StatusCode::out_of_memory;
}

bool is_better(const Result<Model>& one, const Result<Model>& other) {
  if (!one || !other) return one.ok();
  const std::size_t faces = one->surfaces.size(), others = other->surfaces.size();
  return faces > others || (faces == others && one->warnings.size() < other->warnings.size());
}

Result<Model> read(CadInput& input, CadFormat format, const CadOptions& options) {
  if (input.is_kept_model()) {
    const Result<std::string_view> bytes = input.bytes();
    return bytes ? read_kept_model(*bytes, input.name()) : bytes.status();
  }
  if (format != CadFormat::step || options.step_reader == StepReader::opencascade)
    return read_by_program(input, format, options);
  Result<Model> own = read_by_tessera(input, options);
  if (options.step_reader == StepReader::tessera || !may_be_improved(own)) return own;
  Result<Model> other = read_by_program(input, format, options);
  const bool is_cancelled = !other && other.status().code() == StatusCode::cancelled;
  return is_cancelled || is_better(other, own) ? std::move(other) : std::move(own);
}

/// Reads what `open` opens, a file of this name.
template <class Open>
Result<Model> read(const fs::path& name, const CadOptions& options, const Open& open) {
  const CadFormat format = options.format == CadFormat::by_extension ? cad_format_of(name) : options.format;
  if (format == CadFormat::by_extension)
    return Status(StatusCode::unsupported, name.string() + ": unsupported format \"" + lower_extension(name) +
                                               "\": CAD files are read as " + listed_cad_extensions().substr(2));
  Result<CadInput> input = open();
  if (!input) return input.status();
  Result<Model> model = read(*input, format, options);
  if (model) model->name = without_gz(name).stem().string();
  return model;
}

}  // namespace

CadFormat cad_format_of(const fs::path& path) {
  std::string_view name = path.native();
  name.remove_prefix(name.rfind('/') + 1);  // 0 if there is no '/'
  std::string_view extension = extension_of(name);
  if (is_extension(extension, ".gz")) extension = extension_of(name.substr(0, name.size() - extension.size()));
  for (const CadExtension& known : cad_extensions)
    if (is_extension(extension, known.extension)) return known.format;
  return CadFormat::by_extension;
}

std::string listed_cad_extensions() {
  std::string list;
  for (const CadExtension& known : cad_extensions) list += ", " + std::string(known.extension);
  return list;
}

bool is_cad_file(const fs::path& path) { return cad_format_of(path) != CadFormat::by_extension; }

Result<Model> read_cad(const fs::path& path, const CadOptions& options) {
  return guarded([&] { return read(path, options, [&] { return CadInput::open(path); }); });
}

Result<Model> parse_cad(std::string_view bytes, const fs::path& name, const CadOptions& options) {
  return guarded([&] { return read(name, options, [&] { return CadInput::memory(bytes, name); }); });
}

}}  // namespace tessera::abi_0_1
