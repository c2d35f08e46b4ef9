#include "tessera/mesh_assembly.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "tess/cells/mesh_faces.h"
#include "tess/mesh/mesh_parts.h"
#include "tessera/guard.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

Status in_instance(std::size_t k, const std::string& name, StatusCode code, const std::string& sentence) {
  return {code, "instance " + std::to_string(k) + (name.empty() ? "" : " (" + name + ")") + ": " + sentence,
          static_cast<std::ptrdiff_t>(k)};
}

Status no_such_shape(std::size_t k, const std::string& name, std::size_t shape, std::size_t count) {
  return in_instance(k, name, StatusCode::invalid_argument,
                     "it is of shape " + std::to_string(shape) + ", there are " + std::to_string(count));
}

Status check_mesh(const Mesh& mesh) {
  const std::size_t vertices = mesh.vertex_count();
  const bool fits = mesh.positions.size() == 3 * vertices && mesh.indices.size() % 3 == 0 &&
                    mesh.quads.size() % 4 == 0 &&
                    (mesh.model_positions.empty() || mesh.model_positions.size() == 3 * vertices) &&
                    (mesh.normals.empty() || mesh.normals.size() == 3 * vertices) &&
                    (mesh.parameters.empty() || mesh.parameters.size() == 2 * vertices);
  if (!fits) return {StatusCode::count_mismatch, "the mesh's arrays have lengths that do not fit each other"};
  const auto is_beyond = [vertices](std::uint32_t index) { return index >= vertices; };
  if (std::ranges::any_of(mesh.indices, is_beyond) || std::ranges::any_of(mesh.quads, is_beyond))
    return {StatusCode::invalid_argument, "an index of the mesh is beyond its vertices"};
  const auto is_finite = [](auto x) { return std::isfinite(x); };
  for (const std::vector<float>* const values : {&mesh.positions, &mesh.normals})
    if (!std::ranges::all_of(*values, is_finite))
      return {StatusCode::non_finite, "a vertex of the mesh is not finite in float"};
  return check_parts(mesh);
}

Status check_assembly(const MeshAssembly& assembly) {
  for (std::size_t k = 0; k < assembly.shapes.size(); ++k)
    if (const Status status = check_mesh(assembly.shapes[k].mesh); !status.ok())
      return {status.code(), "shape " + std::to_string(k) + ": " + status.message(), static_cast<std::ptrdiff_t>(k)};
  std::size_t vertices = 0;
  for (std::size_t k = 0; k < assembly.instances.size(); ++k) {
    const MeshInstance& instance = assembly.instances[k];
    if (instance.shape >= assembly.shapes.size())
      return no_such_shape(k, instance.name, instance.shape, assembly.shapes.size());
    if (!is_finite(instance.placement))
      return in_instance(k, instance.name, StatusCode::non_finite, "its placement is not finite");
    vertices += assembly.shapes[instance.shape].mesh.vertex_count();
  }
  if (vertices <= std::numeric_limits<std::uint32_t>::max()) return {};
  return {StatusCode::count_mismatch,
          "all instances together have " + std::to_string(vertices) + " vertices, a mesh is limited to 4294967295"};
}

/// Whether the numbers are finite as they are stored.
template <class Number>
bool append(std::vector<Number>& values, const Vec3& v) {
  for (const double x : {v.x, v.y, v.z}) values.push_back(static_cast<Number>(x));
  return std::all_of(values.end() - 3, values.end(), [](Number x) { return std::isfinite(x); });
}

/// Adds instances to one mesh.
class Flattening {
 public:
  explicit Flattening(const MeshAssembly& assembly) : assembly_(assembly) {
    Box3 box;
    for (const MeshInstance& instance : assembly.instances) {
      const Mesh& mesh = mesh_of(instance);
      for (std::size_t k = 0; k < mesh.vertex_count(); ++k)
        box.extend(instance.placement.point(mesh.origin + vector_at(mesh.positions, k)));
      if (mesh.vertex_count() == 0) continue;
      has_normals_ &= !mesh.normals.empty();
      has_parameters_ &= !mesh.parameters.empty();
      has_doubles_ &= !mesh.model_positions.empty();
    }
    if (!box.empty()) flat_.origin = box.centre();
  }

  /// Whether the instance's vertices are finite as they are stored.
  bool add(const MeshInstance& instance) {
    const Mesh& mesh = mesh_of(instance);
    const std::size_t base = flat_.vertex_count();
    const bool finite = add_vertices(mesh, instance.placement);
    add_parts(flat_, mesh, instance);
    const bool mirrors = instance.placement.determinant() < 0;
    add_faces<3>(flat_.indices, mesh.indices, base, mirrors);
    add_faces<4>(flat_.quads, mesh.quads, base, mirrors);
    return finite;
  }

  Mesh take() && { return std::move(flat_); }

  /// Adds the parts of an instance, whose faces come after those that `flat` has.
  static void add_parts(Mesh& flat, const Mesh& mesh, const MeshInstance& instance) {
    const auto add = [&](MeshPart part) {
      part.first_triangle += flat.triangle_count();
      part.first_quad += flat.quad_count();
      if (!part.colour) part.colour = instance.colour;
      flat.parts.push_back(std::move(part));
    };
    if (mesh.parts.empty()) add({instance.name, 0, mesh.triangle_count(), 0, mesh.quad_count()});
    for (MeshPart part : mesh.parts) {
      if (!instance.name.empty()) part.name = instance.name + "/" + part.name;
      add(std::move(part));
    }
  }

 private:
  const Mesh& mesh_of(const MeshInstance& instance) const { return assembly_.shapes[instance.shape].mesh; }

  /// Whether all of them are finite.
  bool add_vertices(const Mesh& mesh, const Affine& placement) {
    const Vec3 offset = placement.point(mesh.origin) - flat_.origin;
    const std::array<Vec3, 3>& c = placement.columns;
    // Normals turn with the cofactors, which are the inverse transposed but for a factor.
    const Affine cofactors{.columns = {cross(c[1], c[2]), cross(c[2], c[0]), cross(c[0], c[1])}};
    const double sign = placement.determinant() < 0 ? -1 : 1;
    const bool turns = c != Affine().columns;
    bool finite = true;
    for (std::size_t k = 0; k < mesh.vertex_count(); ++k) {
      finite &= append(flat_.positions, placement.vector(vector_at(mesh.positions, k)) + offset);
      if (has_doubles_) finite &= append(flat_.model_positions, placement.point(vector_at(mesh.model_positions, k)));
      if (!has_normals_) continue;
      const Vec3 normal = vector_at(mesh.normals, k);
      finite &= append(flat_.normals, turns ? sign * normalized(cofactors.vector(normal)) : normal);
    }
    if (has_parameters_)
      flat_.parameters.insert(flat_.parameters.end(), mesh.parameters.begin(), mesh.parameters.end());
    return finite;
  }

  /// Adds faces of `Corners` corners, the other way around if `mirrors`.
  template <std::size_t Corners>
  static void add_faces(std::vector<std::uint32_t>& to, const std::vector<std::uint32_t>& from, std::size_t base,
                        bool mirrors) {
    for (std::size_t k = 0; k < from.size(); k += Corners)
      for (std::size_t corner = 0; corner < Corners; ++corner)
        to.push_back(static_cast<std::uint32_t>(base) + from[k + (mirrors ? (Corners - corner) % Corners : corner)]);
  }

  const MeshAssembly& assembly_;
  Mesh flat_;
  bool has_normals_ = true, has_parameters_ = true, has_doubles_ = true;
};

}  // namespace

Result<MeshAssembly> instances_of(const Model& model) {
  return guarded([&]() -> Result<MeshAssembly> {
    MeshAssembly assembly{.name = model.name, .unit = model.unit};
    for (const Shape& shape : model.shapes) assembly.shapes.push_back({.name = *shape.name});
    for (std::size_t k = 0; k < model.instances.size(); ++k) {
      const Instance& instance = model.instances[k];
      if (instance.shape >= model.shapes.size())
        return no_such_shape(k, *instance.name, instance.shape, model.shapes.size());
      assembly.instances.push_back({*instance.name, instance.shape, *instance.placement, instance.colour});
    }
    return assembly;
  });
}

Result<Mesh> flatten(const MeshAssembly& assembly) {
  return guarded([&]() -> Result<Mesh> {
    if (Status status = check_assembly(assembly); !status.ok()) return status;
    if (assembly.instances.size() == 1 && assembly.instances[0].placement == Affine()) {
      const MeshInstance& instance = assembly.instances[0];
      Mesh flat = assembly.shapes[instance.shape].mesh;
      Mesh parts;
      Flattening::add_parts(parts, assembly.shapes[instance.shape].mesh, instance);
      flat.parts = std::move(parts.parts);
      return flat;
    }
    Flattening flattening(assembly);
    for (const MeshInstance& instance : assembly.instances)
      if (!flattening.add(instance))
        return Status(StatusCode::non_finite, "the instances together are beyond the range of float");
    return std::move(flattening).take();
  });
}

}}  // namespace tessera::abi_0_1
