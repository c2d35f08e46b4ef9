#pragma once
// Patches to triangles.

#include <memory>
#include <optional>
#include <vector>

#include "tessera/execution.h"
#include "tessera/isa.h"
#include "tessera/mesh.h"
#include "tessera/patch_set.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera {

struct Model;

/// How finely patches are divided.
struct TessellationOptions {
  int rate_u = 8;               ///< segments along u of every patch, 1 to 4096
  int rate_v = 8;               ///< segments along v
  std::optional<Isa> isa = {};  ///< default_isa() if empty
};

/// Uniform tessellation: every patch at the same rates. Layout of the vertices: `[patch][iu][iv]`, so vertex
/// (patch * (rate_u + 1) + iu) * (rate_v + 1) + iv. Border vertices are duplicated, one a patch; where two patches share
/// the border's control points and run at equal rates, they are the same bits. Triangles that collapse at a pole are left out.
class TessellationPlan {
 public:
  /// Errors: invalid_argument (a rate out of range, counts that overflow 32-bit indices), isa_unavailable, unsupported
  /// (the set has no float Bernstein blocks). Memory: 24 bytes a patch.
  static Result<TessellationPlan> make(const PatchSet& set, const TessellationOptions& options = {});

  TessellationPlan(TessellationPlan&&) noexcept;
  TessellationPlan& operator=(TessellationPlan&&) noexcept;
  ~TessellationPlan();

  MeshCapacity capacity() const;  ///< exact, of triangles alone
  /// The same with quads: cells that are whole are quads, those at poles stay triangles.
  MeshCapacity quad_capacity() const;
  int rate_u() const;  ///< segments along u of every patch
  int rate_v() const;  ///< segments along v
  /// A mesh of the right size with all attributes, of triangles.
  Result<Mesh> allocate() const;
  /// The same for quads, and for triangles where there are none.
  Result<Mesh> allocate_quads() const;
  /// Writes the mesh, with quads if there is a view of them. `set` is the one that the plan was made for, at any revision
  /// that collapses the same edges.
  /// Errors: buffer_too_small, stale, invalid_argument, cancelled. Nothing is written on any but cancelled.
  /// The same bytes for any number of threads. Allocates nothing after the first call.
  Status run(const PatchSet& set, const MeshViews& out, const Execution& execution = {}) const;

  class [[gnu::visibility("hidden")]] Impl;

 private:
  explicit TessellationPlan(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Mesh::parts by surfaces: a part for each run of triangles and quads whose patches come from one surface, with its name in
/// the model ("surface 3" if it has none); they are gone through together, always the next one of the lower patch. `set` is
/// the one of mesh.patches, made of `model`. Errors: count_mismatch (not one patch a triangle and a quad), invalid_argument
/// (no such patch in the set, or surface in the model; index = the triangle or quad).
Result<std::vector<MeshPart>> parts_by_surface(const Mesh& mesh, const PatchSet& set, const Model& model);

}  // namespace tessera
#pragma GCC visibility pop
