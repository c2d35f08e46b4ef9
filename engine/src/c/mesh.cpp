// Meshes of the C interface: checks and files.

#include "c/mesh.h"

#include <span>
#include <vector>

#include "tessera/io.h"
#include "tessera/mesh_assembly.h"

using namespace tessera;

namespace tessera { inline namespace abi_0_1 {
namespace {

std::span<std::uint32_t> list(std::uint32_t* data, std::size_t count) {
  return data ? std::span(data, count) : std::span<std::uint32_t>();
}

template <class T, int N>
void copy_records(const VectorView<T, N>& from, std::vector<T>& to) {
  if (from.empty()) return;
  to.resize(N * from.size);
  for (std::size_t k = 0; k < from.size; ++k)
    for (int c = 0; c < N; ++c) to[N * k + static_cast<std::size_t>(c)] = from.at(k, c);
}

Result<std::vector<MeshPart>> parts_of(const Mesh& mesh, const CSet& set) {
  const Model& model = set.model->model;
  return set.shape ? parts_by_face(mesh, set.set, model.shapes[*set.shape]) : parts_by_surface(mesh, set.set, model);
}

/// Copies a mesh, with the origin of its set.
CStatus placed_copy(const tsr_mesh* mesh, const tsr_set* set, Mesh& copy) {
  if (CStatus status = mesh_copy(mesh, copy); status.code) return status;
  if (!set) return {};
  const Held<CSet> of(set);
  if (!of) return of.error();
  const Reading reading(of->usage);
  if (!reading) return in_use(Object::Kind::set);
  copy.origin = of->set.origin();
  return {};
}

}  // namespace

CStatus named_copy(const tsr_mesh* mesh, const tsr_set* set, Mesh& copy) {
  if (CStatus status = placed_copy(mesh, set, copy); status.code) return status;
  if (!set || !copy.has_patches()) return {};
  const Held<CSet> of(set);
  if (!of) return of.error();
  const Reading reading(of->usage);
  if (!reading) return in_use(Object::Kind::set);
  Result<std::vector<MeshPart>> parts = parts_of(copy, *of);
  if (!parts) return parts.status();
  copy.parts = *std::move(parts);
  return {};
}

CStatus assembly_of(const Model& model, const tsr_mesh* const* meshes, const tsr_set* const* sets, std::size_t count,
                    MeshAssembly& made) {
  if (model.shapes.empty()) return bad("the model has no shapes: save its mesh by tsr_mesh_save()");
  if (count != model.shapes.size())
    return {TSR_COUNT_MISMATCH, "the model has " + std::to_string(model.shapes.size()) + " shapes, found " +
                                    std::to_string(count) + " meshes"};
  Result<MeshAssembly> assembly = instances_of(model);
  if (!assembly) return assembly.status();
  for (std::size_t k = 0; k < count; ++k) {
    if (!meshes[k]) continue;  // nothing of it is seen
    if (CStatus status = named_copy(meshes[k], sets[k], assembly->shapes[k].mesh); status.code) {
      status.index = static_cast<std::ptrdiff_t>(k);
      return status;
    }
  }
  made = *std::move(assembly);
  return {};
}

CStatus mesh_views(const tsr_mesh* mesh, tsr_mesh& read, MeshViews& views) {
  if (!mesh) return null_pointer("mesh");
  if (CStatus status = read_struct("tsr_mesh", mesh, read); status.code) return status;
  if (!read.triangles && read.triangle_count > 0) return null_pointer("triangles");
  if (!read.quads && read.quad_count > 0) return null_pointer("quads");
  if (CStatus status = view_of("position", read.position, views.position); status.code) return status;
  if (CStatus status = view_of("normal", read.normal, views.normal); status.code) return status;
  if (CStatus status = view_of("parameter", read.parameter, views.parameter); status.code) return status;
  if (CStatus status = view_of("position_f64", read.position_f64, views.model_position); status.code) return status;
  constexpr std::size_t most = PTRDIFF_MAX / 16;
  if (read.triangle_count > most || read.quad_count > most) return bad("more faces than memory holds");
  views.indices = list(read.triangles, 3 * read.triangle_count);
  views.patch = list(read.triangle_patches, read.triangle_count);
  views.quads = list(read.quads, 4 * read.quad_count);
  views.quad_patch = list(read.quad_patches, read.quad_count);
  return {};
}

CStatus mesh_copy(const tsr_mesh* mesh, Mesh& copy) {
  tsr_mesh read{};
  MeshViews views;
  if (CStatus status = mesh_views(mesh, read, views); status.code) return status;
  copy_records(views.position, copy.positions);
  copy_records(views.normal, copy.normals);
  copy_records(views.parameter, copy.parameters);
  copy_records(views.model_position, copy.model_positions);
  copy.indices.assign(views.indices.begin(), views.indices.end());
  copy.patches.assign(views.patch.begin(), views.patch.end());
  copy.quads.assign(views.quads.begin(), views.quads.end());
  copy.quad_patches.assign(views.quad_patch.begin(), views.quad_patch.end());
  if (copy.positions.empty() && !copy.model_positions.empty())
    return bad("a mesh needs positions in float beside those in double");
  return {};
}

}}  // namespace tessera::abi_0_1

extern "C" {

tsr_status tsr_mesh_check(const tsr_mesh* mesh, tsr_mesh_report* report) {
  return c_call([&]() -> CStatus {
    Mesh copy;
    if (CStatus status = mesh_copy(mesh, copy); status.code) return status;
    const Result<MeshReport> found = check(copy);
    if (!found) return found.status();
    tsr_mesh_report filled{};
    filled.vertices = found->vertices, filled.distinct_positions = found->distinct_positions;
    filled.triangles = found->triangles, filled.quads = found->quads;
    filled.open_edges = found->open_edges, filled.non_manifold_edges = found->non_manifold_edges;
    filled.inconsistent_edges = found->inconsistent_edges, filled.t_junctions = found->t_junctions;
    filled.flipped_triangles = found->flipped_triangles;
    filled.degenerate_triangles = found->degenerate_triangles;
    filled.non_finite_vertices = found->non_finite_vertices;
    return write_struct("tsr_mesh_report", report, filled);
  });
}

tsr_status tsr_mesh_save(const tsr_mesh* mesh, const tsr_set* set, const char* path) {
  return c_call([&]() -> CStatus {
    if (!path) return null_pointer("path");
    Mesh copy;
    if (CStatus status = named_copy(mesh, set, copy); status.code) return status;
    return write_mesh(copy, path);
  });
}

tsr_status tsr_mesh_rounding(const tsr_mesh* mesh, const tsr_set* set, const char* path, double* rounding) {
  return c_call([&]() -> CStatus {
    if (!path || !rounding) return null_pointer(path ? "rounding" : "path");
    Mesh copy;
    if (CStatus status = placed_copy(mesh, set, copy); status.code) return status;
    if (Status status = check_mesh_format(path); !status.ok()) return status;
    *rounding = file_rounding(copy, path);
    return {};
  });
}

tsr_status tsr_model_save_meshes(const tsr_model* model, const tsr_mesh* const* meshes, const tsr_set* const* sets,
                                 size_t count, const char* path) {
  return c_call([&]() -> CStatus {
    const Held<CModel> of(model);
    if (!of) return of.error();
    if (!meshes || !sets || !path) return null_pointer(!meshes ? "meshes" : !sets ? "sets" : "path");
    MeshAssembly assembly;
    if (CStatus status = assembly_of(of->model, meshes, sets, count, assembly); status.code) return status;
    return write_assembly(assembly, path);
  });
}

}  // extern "C"
