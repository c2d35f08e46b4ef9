#include "tessera/io.h"

#include <array>
#include <string>
#include <system_error>
#include <type_traits>

#include "io/cad/cad_reader.h"
#include "io/file/file.h"
#include "io/file/gzip.h"
#include "io/format/output_formats.h"
#include "io/mesh/mesh_formats.h"
#include "io/mesh/valid_mesh.h"
#include "io/spline/model_formats.h"
#include "tessera/cad.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

namespace fs = std::filesystem;

struct Format {
  std::string_view extension;
  Result<Model> (*read_model)(std::string_view, std::string_view) = nullptr;
  Result<Mesh> (*read_mesh)(std::string_view, std::string_view, const MeshReadOptions&) = nullptr;
  Status (*write_mesh)(const Mesh&, OutputFile&, const MeshWriteOptions&) = nullptr;
  Status (*write_assembly)(const MeshAssembly&, OutputFile&, const MeshWriteOptions&) = nullptr;  ///< none: as one mesh
  decltype(&write_bpt) write_model = nullptr;
};

constexpr std::array<Format, 10> formats{{
    {.extension = ".bpt", .read_model = parse_bpt, .write_model = write_bpt},
    {.extension = ".bv", .read_model = parse_bv},
    {.extension = ".g2", .read_model = parse_g2},
    {.extension = ".json", .read_model = parse_json_model, .write_model = write_json_model},
    {.extension = ".obj",
     .read_model = parse_obj_freeform,
     .read_mesh = parse_obj,
     .write_mesh = write_obj,
     .write_model = write_obj_freeform},
    {.extension = ".rib", .read_model = parse_rib},
    {.extension = ".ply", .read_mesh = parse_ply, .write_mesh = write_ply},
    {.extension = ".stl", .read_mesh = parse_stl, .write_mesh = write_stl},
    {.extension = ".glb", .read_mesh = parse_gltf, .write_mesh = write_glb, .write_assembly = write_glb_assembly},
    {.extension = ".gltf", .read_mesh = parse_gltf, .write_mesh = write_gltf, .write_assembly = write_gltf_assembly},
}};

constexpr std::string_view mesh_writers = "meshes are written", model_writers = "surfaces are written",
                           model_readers = "surfaces are read";

/// The format of this extension, if it has the ability `member`; otherwise an error for the file `path` that lists the
/// formats that have it.
template <class Ability>
Result<const Format*> find_format(const fs::path& path, const std::string& extension, Ability Format::*member,
                                  std::string_view what) {
  std::string able;
  for (const Format& format : formats) {
    if (!(format.*member)) continue;
    if (format.extension == extension) return &format;
    able += (able.empty() ? "" : ", ") + std::string(format.extension);
  }
  if constexpr (std::is_same_v<decltype(member), decltype(&Format::read_model)>) able += listed_cad_extensions();
  return Status(StatusCode::unsupported,
                path.string() + ": unsupported format \"" + extension + "\": " + std::string(what) + " as " + able);
}

/// The content of the file, unpacked if it is packed. `as`: a file name that states the format. A file that cannot be
/// opened is reported before an unknown format.
template <class Content, class Ability, class... Options>
Result<Content> read_as(const fs::path& path, const fs::path& as, Ability Format::*member, std::string_view what,
                        const Options&... options) {
  const Result<const Format*> format = find_format(path, lower_extension(without_gz(as)), member, what);
  std::error_code error;
  if (!format && fs::exists(path, error) && !fs::is_directory(path, error)) return format.status();
  Result<FileBytes> read = read_file_bytes(path);
  if (!read) return read.status();
  if (!format) return format.status();
  const std::string_view bytes = view_of(*read);
  if (!is_gzip(as, bytes)) return ((*format)->*member)(bytes, path.string(), options...);
  const Result<std::string> unpacked = unpack_gzip(bytes, path.string());
  if (!unpacked) return unpacked.status();
  *read = {};
  return ((*format)->*member)(*unpacked, path.string(), options...);
}

/// The model in these bytes, unpacked if they are packed.
Result<Model> parse_as(std::string_view bytes, const std::string& name, const fs::path& as) {
  const Result<const Format*> format =
      find_format(name, lower_extension(without_gz(as)), &Format::read_model, model_readers);
  if (!format) return format.status();
  if (bytes.empty()) return Status(StatusCode::parse_error, name + ": the file is empty");
  if (!is_gzip(as, bytes)) return (*format)->read_model(bytes, name);
  const Result<std::string> unpacked = unpack_gzip(bytes, name);
  return unpacked ? (*format)->read_model(*unpacked, name) : unpacked.status();
}

/// A file name whose extension states the format.
fs::path named_by_format(const fs::path& name, const std::string& format) {
  if (format.empty()) return name;
  return (format.starts_with('.') ? "model" : "model.") + format;
}

/// Reads a model by one of two functions, which take a file name that states the format.
template <class Cad, class Other>
Result<Model> read_model(const fs::path& name, const ModelReadOptions& options, const Cad& cad, const Other& other) {
  const fs::path as = named_by_format(name, options.format);
  CadOptions stated = options.cad;
  stated.format = cad_format_of(as);
  if (stated.format != CadFormat::by_extension) return cad(stated);
  Result<Model> model = other(as);
  if (model) model->name = without_gz(name).stem().string();
  return model;
}

Status in_output(const fs::path& path, const Status& status) {
  return status.ok() ? status : Status(status.code(), path.string() + ": " + status.message(), status.index());
}

/// Makes the file by `open`, fills it by `write` and commits it.
template <class Open, class Write>
Status write_opened(const fs::path& path, const Open& open, const Write& write) {
  return guarded([&]() -> Status {
    if (const Status status = check_mesh_format(path); !status.ok()) return status;
    Result<OutputFile> out = open();
    if (!out) return out.status();
    const Status status = write(*out);
    return status.ok() ? out->commit() : status;
  });
}
template <class Write>
Status write_file(const fs::path& path, const Write& write) {
  return write_opened(
      path, [&] { return OutputFile::make(path); }, write);
}
/// The bytes of the file that `write` fills.
template <class Write>
Result<std::string> written_bytes(const fs::path& name, const Write& write) {
  std::string bytes;
  const Status status = write_opened(
      name, [&] { return OutputFile::memory(bytes, name); }, write);
  if (!status.ok()) return status;
  return bytes;
}

}  // namespace

std::string lower_extension(const fs::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return extension;
}

Status check_mesh_format(const fs::path& path) {
  return guarded([&] { return find_format(path, lower_extension(path), &Format::write_mesh, mesh_writers).status(); });
}

Status check_model_format(const fs::path& path) {
  return guarded([&] { return surface_writer(path).status(); });
}

Result<SurfaceWriter> surface_writer(const fs::path& path) {
  const Result<const Format*> format = find_format(path, lower_extension(path), &Format::write_model, model_writers);
  if (!format) return format.status();
  return SurfaceWriter{(*format)->write_model};
}

Result<Model> read_model(const fs::path& path, const ModelReadOptions& options) {
  return guarded([&] {
    return read_model(
        path, options, [&](const CadOptions& cad) { return read_cad(path, cad); },
        [&](const fs::path& as) { return read_as<Model>(path, as, &Format::read_model, model_readers); });
  });
}

Result<Model> parse_model(std::string_view bytes, const fs::path& name, const ModelReadOptions& options) {
  return guarded([&] {
    return read_model(
        name, options, [&](const CadOptions& cad) { return parse_cad(bytes, name, cad); },
        [&](const fs::path& as) { return parse_as(bytes, name.string(), as); });
  });
}

Result<Mesh> read_mesh(const fs::path& path, const MeshReadOptions& options) {
  return guarded([&] { return read_as<Mesh>(path, path, &Format::read_mesh, "meshes are read", options); });
}

Status write_mesh(const Mesh& mesh, const fs::path& path, OutputFile& out, const MeshWriteOptions& options) {
  return guarded([&]() -> Status {
    const Result<const Format*> format = find_format(path, lower_extension(path), &Format::write_mesh, mesh_writers);
    if (!format) return format.status();
    const Status status = validate(mesh);
    return in_output(path, status.ok() ? (*format)->write_mesh(mesh, out, options) : status);
  });
}

Status write_assembly(const MeshAssembly& assembly, const fs::path& path, OutputFile& out,
                      const MeshWriteOptions& options) {
  return guarded([&]() -> Status {
    const Result<const Format*> format = find_format(path, lower_extension(path), &Format::write_mesh, mesh_writers);
    if (!format) return format.status();
    if (const Status status = validate(assembly); !status.ok()) return in_output(path, status);
    if ((*format)->write_assembly) return in_output(path, (*format)->write_assembly(assembly, out, options));
    const Result<Mesh> flat = flatten(assembly);
    return flat ? write_mesh(*flat, path, out, options) : in_output(path, flat.status());
  });
}

Status write_mesh(const Mesh& mesh, const fs::path& path, const MeshWriteOptions& options) {
  return write_file(path, [&](OutputFile& out) { return write_mesh(mesh, path, out, options); });
}
Status write_assembly(const MeshAssembly& assembly, const fs::path& path, const MeshWriteOptions& options) {
  return write_file(path, [&](OutputFile& out) { return write_assembly(assembly, path, out, options); });
}

Result<std::string> mesh_bytes(const Mesh& mesh, const fs::path& name, const MeshWriteOptions& options) {
  return written_bytes(name, [&](OutputFile& out) { return write_mesh(mesh, name, out, options); });
}
Result<std::string> assembly_bytes(const MeshAssembly& assembly, const fs::path& name,
                                   const MeshWriteOptions& options) {
  return written_bytes(name, [&](OutputFile& out) { return write_assembly(assembly, name, out, options); });
}

}}  // namespace tessera::abi_0_1
