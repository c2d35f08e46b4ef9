// glTF 2.0 (Khronos Group, glTF 2.0 Specification, 2021). All numbers lie in one buffer: positions, normals and
// parameters of all vertices of a mesh, then its indices.

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <string>

#include "io/file/text_cursor.h"
#include "io/mesh/gltf_content.h"
#include "io/mesh/mesh_formats.h"
#include "tessera/mesh_assembly.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::size_t max_bytes =
    std::numeric_limits<std::int32_t>::max();  // readers keep offsets in int, as tinygltf does

Status check_size(std::size_t bytes) {
  if (bytes <= max_bytes) return {};
  return {StatusCode::unsupported,
          "the mesh takes " + std::to_string(bytes) + " bytes, a glTF file is limited to " + std::to_string(max_bytes)};
}

Status no_triangles() { return {StatusCode::invalid_argument, "the mesh has no triangles, glTF needs at least one"}; }

/// One node and one mesh for each part.
Status write(const Mesh& mesh, OutputFile& out, const MeshWriteOptions& options, bool binary) {
  if (!mesh.quads.empty()) {
    const Result<Mesh> split = split_quads(mesh);
    return split ? write(*split, out, options, binary) : split.status();
  }
  if (mesh.triangle_count() == 0) return no_triangles();
  if (Status status = check_size(GltfContent::byte_count(mesh)); !status.ok()) return status;
  GltfContent content({.placement = up_from(options.up), .origin = mesh.origin});
  content.add_vertices(mesh);
  std::vector<MeshPart> parts = mesh.parts;
  if (parts.empty()) parts.push_back({{}, 0, mesh.triangle_count()});
  for (const MeshPart& part : parts) {
    if (part.triangle_count == 0) continue;
    const std::span indices = std::span(mesh.indices).subspan(3 * part.first_triangle, 3 * part.triangle_count);
    const auto [least, most] = std::minmax_element(indices.begin(), indices.end());
    GltfPrimitive primitive = content.add_primitive({indices}, *least, *most - *least + 1);
    primitive.material = content.material(part.colour);
    content.add_node({.name = part.name, .mesh = content.add_mesh(part.name, {&primitive, 1})});
  }
  return content.write(out, binary, options.packed);
}

/// Adds the vertices and triangles of a shape, by colours in the order of their first parts.
std::vector<GltfPrimitive> add_shape(GltfContent& content, const Mesh& mesh) {
  std::vector<std::pair<int, GltfContent::IndexRuns>> colours;  // by material
  std::map<int, std::size_t> places;                            // in it
  const auto add = [&](int material, std::size_t first, std::size_t count) {
    if (count == 0) return;
    const auto [place, is_new] = places.try_emplace(material, colours.size());
    if (is_new) colours.push_back({material, {}});
    colours[place->second].second.push_back(std::span(mesh.indices).subspan(3 * first, 3 * count));
  };
  for (const MeshPart& part : mesh.parts) add(content.material(part.colour), part.first_triangle, part.triangle_count);
  if (mesh.parts.empty()) add(content.material({}), 0, mesh.triangle_count());
  std::vector<GltfPrimitive> added;
  if (!colours.empty()) content.add_vertices(mesh);
  for (auto& [material, indices] : colours) {
    added.push_back(content.add_primitive(std::move(indices), 0, mesh.vertex_count()));
    added.back().material = material;
  }
  return added;
}

/// The primitives of an instance; its colour is for triangles without one.
std::vector<GltfPrimitive> coloured(std::vector<GltfPrimitive> primitives, int none, int colour) {
  for (GltfPrimitive& primitive : primitives)
    if (primitive.material == none) primitive.material = colour;
  return primitives;
}

/// Whether a node can have the placement: it turns, scales and moves, but does not shear (section 3.5.3).
bool fits_node(const Affine& placement) {
  constexpr double rounding = 1e-6;
  const std::array<Vec3, 3>& c = placement.columns;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 &a = c[k], &b = c[(k + 1) % 3];
    if (!(length(a) > 0) || std::abs(dot(a, b)) > rounding * length(a) * length(b)) return false;
  }
  return true;
}

/// Gives a mesh of its own, in place, to each instance whose placement fits no node, and makes triangles of quads.
Status prepare(MeshAssembly& assembly) {
  for (MeshInstance& instance : assembly.instances) {
    if (fits_node(instance.placement)) continue;
    const ShapeMesh& shape = assembly.shapes[instance.shape];
    Result<Mesh> placed = flatten({.shapes = {shape}, .instances = {{.placement = instance.placement}}});
    if (!placed) return placed.status();
    instance.shape = assembly.shapes.size();
    instance.placement = {};
    assembly.shapes.push_back({shape.name, *std::move(placed)});
  }
  for (ShapeMesh& shape : assembly.shapes) {
    Result<Mesh> split = split_quads(shape.mesh);
    if (!split) return split.status();
    shape.mesh = *std::move(split);
  }
  return {};
}

bool needs_preparation(const MeshAssembly& assembly) {
  return std::ranges::any_of(assembly.shapes, [](const ShapeMesh& shape) { return shape.mesh.quad_count() > 0; }) ||
         !std::ranges::all_of(assembly.instances,
                              [](const MeshInstance& instance) { return fits_node(instance.placement); });
}

/// The metres of a unit, 1 if it is empty; 0 for unknown ones.
double metres(const std::string& unit) { return unit.empty() ? 1 : micrometres_in(unit) / micrometres_in("m"); }

/// Adds all shapes that have instances with triangles, each once, and a node for each instance.
class AssemblyContent {
 public:
  AssemblyContent(const MeshAssembly& assembly, UpAxis up)
      : assembly_(assembly),
        content_({.name = assembly.name, .placement = up_from(up) * scaled(metres(assembly.unit))}) {
    for (const MeshInstance& instance : assembly.instances) add(instance);
  }

  Status write(OutputFile& out, bool binary, bool packed) const { return content_.write(out, binary, packed); }

 private:
  static Affine scaled(double scale) { return Affine::scaled({scale, scale, scale}); }

  void add(const MeshInstance& instance) {
    const ShapeMesh& shape = assembly_.shapes[instance.shape];
    content_.add_node({.name = instance.name.empty() ? shape.name : instance.name,
                       .mesh = mesh_of(instance),
                       .placement = instance.placement,
                       .origin = shape.mesh.origin});
  }

  int mesh_of(const MeshInstance& instance) {
    const ShapeMesh& shape = assembly_.shapes[instance.shape];
    const auto [triangles, is_new] = shapes_.try_emplace(instance.shape);
    if (is_new) triangles->second = add_shape(content_, shape.mesh);
    if (triangles->second.empty()) return -1;
    const int none = content_.material({});
    const bool counts = std::ranges::any_of(triangles->second, [&](const auto& of) { return of.material == none; });
    const int colour = counts ? content_.material(instance.colour) : none;
    const auto [mesh, is_first] = meshes_.try_emplace({instance.shape, colour});
    if (is_first) mesh->second = content_.add_mesh(shape.name, coloured(triangles->second, none, colour));
    return mesh->second;
  }

  const MeshAssembly& assembly_;
  GltfContent content_;
  std::map<std::size_t, std::vector<GltfPrimitive>> shapes_;  ///< by index
  std::map<std::pair<std::size_t, int>, int> meshes_;         ///< by shape and material of triangles without colour
};

/// One mesh for each shape and colour of instances, all of which share the shape's vertices and indices.
Status write(const MeshAssembly& assembly, OutputFile& out, const MeshWriteOptions& options, bool binary) {
  if (metres(assembly.unit) == 0)
    return {StatusCode::unsupported, "glTF is in metres, and the unit " + quote(assembly.unit) +
                                         " is not known; known: um, mm, cm, m, km, in (inch), ft"};
  if (needs_preparation(assembly)) {
    MeshAssembly prepared = assembly;
    const Status status = prepare(prepared);
    return status.ok() ? write(prepared, out, options, binary) : status;
  }
  std::size_t bytes = 0, triangles = 0;
  for (const ShapeMesh& shape : assembly.shapes) bytes += GltfContent::byte_count(shape.mesh);
  for (const MeshInstance& instance : assembly.instances)
    triangles += assembly.shapes[instance.shape].mesh.triangle_count();
  if (triangles == 0) return no_triangles();
  if (Status status = check_size(bytes); !status.ok()) return status;
  return AssemblyContent(assembly, options.up).write(out, binary, options.packed);
}

}  // namespace

Status write_glb(const Mesh& mesh, OutputFile& out, const MeshWriteOptions& options) {
  return write(mesh, out, options, true);
}
Status write_gltf(const Mesh& mesh, OutputFile& out, const MeshWriteOptions& options) {
  return write(mesh, out, options, false);
}
Status write_glb_assembly(const MeshAssembly& assembly, OutputFile& out, const MeshWriteOptions& options) {
  return write(assembly, out, options, true);
}
Status write_gltf_assembly(const MeshAssembly& assembly, OutputFile& out, const MeshWriteOptions& options) {
  return write(assembly, out, options, false);
}

}}  // namespace tessera::abi_0_1
