#include "io/formats.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <system_error>

#include "base/guard.h"
#include "io/file.h"
#include "io/mesh_formats.h"
#include "io/output_file.h"
#include "tessera/io.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

struct Format {
  std::string_view extension;
  Result<Model> (*read_model)(std::string_view, std::string_view) = nullptr;
  Result<Mesh> (*read_mesh)(std::string_view, std::string_view) = nullptr;
  void (*write_mesh)(const Mesh&, OutputFile&) = nullptr;
};

constexpr std::array<Format, 7> formats{{
    {.extension = ".bpt", .read_model = parse_bpt},
    {.extension = ".bv", .read_model = parse_bv},
    {.extension = ".g2", .read_model = parse_g2},
    {.extension = ".json", .read_model = parse_json_model},
    {.extension = ".obj", .read_model = parse_obj_freeform, .read_mesh = parse_obj, .write_mesh = write_obj},
    {.extension = ".rib", .read_model = parse_rib},
    {.extension = ".ply", .read_mesh = parse_ply, .write_mesh = write_ply},
}};

constexpr std::string_view mesh_writers = "meshes are written";

/// The format that `path` names, if it has the ability `member`; otherwise an error that lists those that have.
template <class Ability>
Result<const Format*> find_format(const fs::path& path, Ability Format::*member, std::string_view what) {
  const std::string extension = lower_extension(path);
  std::string able;
  for (const Format& format : formats) {
    if (!(format.*member)) continue;
    if (format.extension == extension) return &format;
    able += (able.empty() ? "" : ", ") + std::string(format.extension);
  }
  return Status(StatusCode::unsupported,
                path.string() + ": unsupported format \"" + extension + "\": " + std::string(what) + " as " + able);
}

/// The file's bytes and its format. What cannot be opened is said before what cannot be understood.
template <class Content, class Ability>
Result<Content> read_as(const fs::path& path, Ability Format::*member, std::string_view what) {
  const Result<const Format*> format = find_format(path, member, what);
  std::error_code error;
  if (!format && fs::exists(path, error) && !fs::is_directory(path, error)) return format.status();
  const Result<std::string> bytes = read_file(path);
  if (!bytes) return bytes.status();
  if (!format) return format.status();
  return ((*format)->*member)(*bytes, path.string());
}

/// That tessera::io_occt reads these files, if it does; else `status`.
Status or_read_elsewhere(const fs::path& path, const Status& status) {
  const std::string extension = lower_extension(path);
  const bool step = extension == ".step" || extension == ".stp", iges = extension == ".iges" || extension == ".igs";
  if (status.code() != StatusCode::unsupported || (!step && !iges)) return status;
  return Status(StatusCode::unsupported,
                path.string() + ": unsupported format \"" + extension + "\": " + (step ? "STEP" : "IGES") +
                    " is read where OpenCASCADE is installed (libocct-data-exchange-dev) when Tessera is built, by "
                    "read_cad of tessera/io_occt.h");
}

/// Lengths that fit each other, indices in range, numbers that fit float.
Status validate(const Mesh& mesh) {
  const std::size_t vertices = mesh.vertex_count(), triangles = mesh.triangle_count();
  const bool lengths_fit = mesh.positions.size() == 3 * vertices && mesh.indices.size() == 3 * triangles &&
                           (mesh.normals.empty() || mesh.normals.size() == 3 * vertices) &&
                           (mesh.parameters.empty() || mesh.parameters.size() == 2 * vertices) &&
                           (mesh.patches.empty() || mesh.patches.size() == triangles);
  if (!lengths_fit)
    return Status(StatusCode::count_mismatch, "the mesh's arrays have lengths that do not fit each other");
  if (vertices > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
    return Status(StatusCode::invalid_argument, "the mesh has more vertices than files can index (2147483647)");
  }
  const auto bad_index = std::find_if(mesh.indices.begin(), mesh.indices.end(), [&](auto k) { return k >= vertices; });
  if (bad_index != mesh.indices.end()) {
    return Status(StatusCode::invalid_argument, "an index of the mesh is beyond its vertices",
                  bad_index - mesh.indices.begin());
  }
  for (std::size_t k = 0; k < mesh.positions.size(); ++k) {
    const double origin = std::array{mesh.origin.x, mesh.origin.y, mesh.origin.z}[k % 3];
    const bool normal_finite = mesh.normals.empty() || std::isfinite(mesh.normals[k]);
    if (!std::isfinite(file_coordinate(origin, mesh.positions[k])) || !normal_finite) {
      return Status(StatusCode::non_finite, "a vertex of the mesh is not finite in float",
                    static_cast<std::ptrdiff_t>(k / 3));
    }
  }
  const auto finite = [](float value) { return std::isfinite(value); };
  if (!std::all_of(mesh.parameters.begin(), mesh.parameters.end(), finite)) {
    return Status(StatusCode::non_finite, "a parameter of the mesh is not finite");
  }
  return {};
}

}  // namespace

std::string lower_extension(const fs::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return extension;
}

Status check_mesh_format(const fs::path& path) { return find_format(path, &Format::write_mesh, mesh_writers).status(); }

Result<Model> read_model(const fs::path& path) {
  return guarded([&]() -> Result<Model> {
    Result<Model> model = read_as<Model>(path, &Format::read_model, "surfaces are read");
    if (!model) return or_read_elsewhere(path, model.status());
    model->name = path.stem().string();
    return model;
  });
}

Result<Mesh> read_mesh(const fs::path& path) {
  return guarded([&] { return read_as<Mesh>(path, &Format::read_mesh, "meshes are read"); });
}

Status write_mesh(const Mesh& mesh, const fs::path& path, OutputFile& out) {
  return guarded([&]() -> Status {
    const Result<const Format*> format = find_format(path, &Format::write_mesh, mesh_writers);
    if (!format) return format.status();
    Status status = validate(mesh);
    if (!status.ok()) return Status(status.code(), path.string() + ": " + status.message(), status.index());
    (*format)->write_mesh(mesh, out);
    return {};
  });
}

Status write_mesh(const Mesh& mesh, const fs::path& path) {
  return guarded([&]() -> Status {
    Status status = check_mesh_format(path);
    if (!status.ok()) return status;
    Result<OutputFile> out = OutputFile::create(path);
    if (!out) return out.status();
    status = write_mesh(mesh, path, *out);
    return status.ok() ? out->commit() : status;
  });
}

}  // namespace tessera
