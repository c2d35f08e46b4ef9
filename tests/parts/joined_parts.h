#pragma once
// Meshes of models in parts, put together again.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "support/synthetic_sets.h"
#include "tessera/part_mesh.h"

namespace tessera::test {

/// The mesh of a set of the whole model.
inline Result<Mesh> whole_mesh(const Model& model, const TessellationOptions& options) {
  const Result<PatchSet> set = make_patch_set(model);
  if (!set) return set.status();
  const Result<Tessellation> plan = Tessellation::make(*set, options);
  if (!plan) return plan.status();
  Result<Mesh> mesh = plan->allocate();
  if (!mesh) return mesh;
  const Status status = plan->run(*set, mesh->views());
  return status.ok() ? mesh : status;
}

/// Appends a part's mesh to that of the parts before it.
inline void append(const Mesh& part, std::uint32_t patches_before, Mesh& mesh) {
  const auto add = [](const auto& from, auto& to) { to.insert(to.end(), from.begin(), from.end()); };
  const auto add_raised = [](const std::vector<std::uint32_t>& from, std::uint32_t by, std::vector<std::uint32_t>& to) {
    for (const std::uint32_t value : from) to.push_back(value + by);
  };
  const auto vertices = static_cast<std::uint32_t>(mesh.vertex_count());
  mesh.origin = part.origin;
  add(part.positions, mesh.positions), add(part.normals, mesh.normals), add(part.parameters, mesh.parameters);
  add(part.model_positions, mesh.model_positions);
  add_raised(part.indices, vertices, mesh.indices), add_raised(part.quads, vertices, mesh.quads);
  add_raised(part.patches, patches_before, mesh.patches),
      add_raised(part.quad_patches, patches_before, mesh.quad_patches);
}

/// Cuts a model into runs of surfaces that end at `ends`, the last of which is the number of surfaces, and meshes each.
inline Result<Mesh> mesh_in_parts(const Model& model, const std::vector<std::size_t>& ends,
                                  const TessellationOptions& options) {
  const Result<SurfaceExtents> extents = surface_extents(model);
  if (!extents) return extents.status();
  Mesh mesh;
  std::size_t first = 0, patches = 0;
  for (const std::size_t end : ends) {
    const Result<ModelPart> part = part_of(model, *extents, first, end, part_reach(options, extents->box()));
    if (!part) return part.status();
    const Result<PartMesh> own = tessellate_part(*part, options);
    if (!own) return own.status();
    append(own->mesh, static_cast<std::uint32_t>(patches), mesh);
    patches += own->own.patches;
    first = end;
  }
  return mesh;
}

/// Returns the first list in which two meshes differ; empty if they are the same, bit for bit.
inline std::string difference(const Mesh& a, const Mesh& b) {
  const auto differ = [](const auto& x, const auto& y) {
    return x.size() != y.size() || (!x.empty() && std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) != 0);
  };
  const auto count = [](const char* what, std::size_t x, std::size_t y) {
    return what + std::string(": ") + std::to_string(x) + " and " + std::to_string(y);
  };
  if (!(a.origin == b.origin)) return "origins";
  if (a.vertex_count() != b.vertex_count()) return count("vertices", a.vertex_count(), b.vertex_count());
  if (a.triangle_count() != b.triangle_count()) return count("triangles", a.triangle_count(), b.triangle_count());
  if (differ(a.indices, b.indices)) return "indices";
  if (differ(a.positions, b.positions)) return "positions";
  if (differ(a.model_positions, b.model_positions)) return "positions in double";
  if (differ(a.normals, b.normals)) return "normals";
  if (differ(a.parameters, b.parameters)) return "parameters";
  if (differ(a.patches, b.patches) || differ(a.quad_patches, b.quad_patches)) return "patches";
  return differ(a.quads, b.quads) ? "quads" : "";
}

}  // namespace tessera::test
