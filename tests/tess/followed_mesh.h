#pragma once
// A set, its plan and its mesh, which follow edits.

#include <cmath>

#include "tess/tessellate_support.h"

namespace tessera::test {

/// New points for some patches.
struct Edits {
  std::vector<std::uint32_t> patch;
  std::vector<Vec3> points;

  operator PatchEdits() const { return {patch, points}; }
};

/// Edits of every step-th patch: `move` moves each point.
template <class Move>
Edits moved(const PatchSet& set, std::size_t step, Move move) {
  Edits edits;
  for (std::size_t k = 0; k < set.patch_count(); k += step) {
    edits.patch.push_back(static_cast<std::uint32_t>(k));
    for (const Vec3& p : set.patch(k).points()) edits.points.push_back(move(p));
  }
  return edits;
}
inline Edits swollen(const PatchSet& set, std::size_t step, double by) {
  return moved(set, step, [by](const Vec3& p) { return Vec3{p.x + by * std::sin(p.y), p.y, p.z * (1 + by)}; });
}

struct Animated {
  PatchSet set;
  Tessellation plan;
  Mesh mesh;

  Animated(const std::vector<BezierPatch>& patches, const TessellationOptions& options)
      : set(set_of(patches)), plan(good(Tessellation::make(set, options))) {
    mesh = mesh_of(set, plan);
  }
  /// Follows the edits, and writes the mesh anew if it has another topology.
  MeshChange run(const Edits& edits, const Execution& execution = {}) {
    const Mesh before = mesh;
    const MeshChange change = good(plan.update(set, edits, mesh.views(), execution));
    EXPECT_EQ(change.topology, change.patches > 0);
    if (!change.topology) return change;
    EXPECT_EQ(mesh.positions, before.positions);
    EXPECT_EQ(mesh.normals, before.normals);
    mesh = mesh_of(set, plan);
    return change;
  }
  void expect_as_anew() {
    const Mesh anew = mesh_of(set, plan);
    EXPECT_EQ(mesh.positions, anew.positions);
    EXPECT_EQ(mesh.normals, anew.normals);
    EXPECT_EQ(mesh.indices, anew.indices);
    EXPECT_EQ(mesh.parameters, anew.parameters);
  }
};

}  // namespace tessera::test
