// Tangents: the derivatives of the patches at the vertices' parameters.

#include <algorithm>
#include <cmath>
#include <string>

#include "base/impl_access.h"
#include "base/text.h"
#include "tess/cells/mesh_faces.h"
#include "tess/cells/parameter_map.h"
#include "tessera/evaluate.h"
#include "tessera/gpu_mesh.h"
#include "tessera/guard.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Returns the unit vector along the part of `of` that is perpendicular to a unit normal; zero if there is next to
/// none.
Vec3 across(const Vec3& normal, const Vec3& of) {
  const Vec3 part = of - dot(of, normal) * normal;
  const double size = length(part);
  return size > 1e-6 * length(of) ? (1 / size) * part : Vec3{};
}

/// Returns some unit vector perpendicular to a unit normal.
Vec3 any_across(const Vec3& normal) { return across(normal, std::abs(normal.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}); }

constexpr std::uint32_t no_patch = ~0u;

/// The parameters of a mesh's vertices on patches.
struct VertexSamples {
  std::vector<std::uint32_t> patch;
  std::vector<float> u, v;

  /// Errors: invalid_argument (index = the vertex).
  Status find(const Mesh& mesh, const PatchSet& set, VertexParameters kind) {
    const std::size_t count = mesh.vertex_count();
    patch.assign(count, no_patch);
    u.assign(count, 0), v.assign(count, 0);
    const auto take = [&](std::span<const std::uint32_t> indices, std::size_t corners,
                          std::span<const std::uint32_t> patches) {
      for (std::size_t k = 0; k < indices.size(); ++k)
        if (patch[indices[k]] == no_patch) patch[indices[k]] = patches[k / corners];
    };
    take(mesh.indices, 3, mesh.patches);
    take(mesh.quads, 4, mesh.quad_patches);
    const ParameterMaps maps(impl_of(set), kind);
    for (std::size_t k = 0; k < count; ++k) {
      if (patch[k] == no_patch) {  // a vertex without faces, at a pole
        patch[k] = 0;
        continue;
      }
      const Domain to = maps.of(patch[k]).to;
      // Floats of parameters are off by their rounding, which may be a part of a small patch.
      constexpr double most = 1e-2;
      const double at_u = to.local_u(double(mesh.parameters[2 * k])),
                   at_v = to.local_v(double(mesh.parameters[2 * k + 1]));
      if (!(at_u >= -most && at_u <= 1 + most && at_v >= -most && at_v <= 1 + most))
        return {StatusCode::invalid_argument,
                "vertex " + std::to_string(k) + " lies at (" + text(at_u) + ", " + text(at_v) + ") of patch " +
                    std::to_string(patch[k]) + ", outside of [0,1]: are its parameters of this kind?",
                static_cast<std::ptrdiff_t>(k)};
      u[k] = static_cast<float>(std::clamp(at_u, 0.0, 1.0)), v[k] = static_cast<float>(std::clamp(at_v, 0.0, 1.0));
    }
    return {};
  }
};

/// Checks that the mesh has all that tangents are made of.
Status check_mesh(const Mesh& mesh, const PatchSet& set) {
  const std::size_t count = mesh.vertex_count();
  if (mesh.parameters.size() != 2 * count || mesh.normals.size() != 3 * count)
    return {StatusCode::invalid_argument, "tangents need a mesh with parameters and normals of all vertices"};
  Status status = check_face_patches(mesh, set.patch_count());
  if (status.ok()) status = check_face_corners("triangle", mesh.indices, 3, count);
  return status.ok() ? check_face_corners("quad", mesh.quads, 4, count) : status;
}

}  // namespace

Result<std::vector<float>> tangents(const Mesh& mesh, const PatchSet& set, VertexParameters parameters,
                                    const Execution& execution) {
  return guarded([&]() -> Result<std::vector<float>> {
    if (Status status = check_mesh(mesh, set); !status.ok()) return status;
    VertexSamples samples;
    if (Status status = samples.find(mesh, set, parameters); !status.ok()) return status;
    const std::size_t count = mesh.vertex_count();
    std::vector<float> tangents(4 * count), along_u(3 * count), along_v(3 * count);
    if (count == 0) return tangents;
    PatchSamples<float> at_patches;
    at_patches.patch = View1<const std::uint32_t>::interleaved(samples.patch);
    at_patches.u = View1<const float>::interleaved(samples.u);
    at_patches.v = View1<const float>::interleaved(samples.v);
    QuantityViews<float> out;
    out.du = View3<float>::interleaved(along_u);
    out.dv = View3<float>::interleaved(along_v);
    if (Status status = evaluate(set, at_patches, out, {}, execution); !status.ok()) return status;
    for (std::size_t k = 0; k < count; ++k) {
      const Vec3 n = vector_at(mesh.normals, k), du = vector_at(along_u, k), dv = vector_at(along_v, k);
      if (!(dot(n, n) > 0)) continue;
      Vec3 tangent = across(n, du);
      if (!(dot(tangent, tangent) > 0)) tangent = across(n, cross(dv, n));
      if (!(dot(tangent, tangent) > 0)) tangent = any_across(n);
      const double sign = dot(cross(n, tangent), dv) < 0 ? -1 : 1;
      const double values[] = {tangent.x, tangent.y, tangent.z, sign};
      for (std::size_t c = 0; c < 4; ++c) tangents[4 * k + c] = static_cast<float>(values[c]);
    }
    return tangents;
  });
}

}}  // namespace tessera::abi_0_1
