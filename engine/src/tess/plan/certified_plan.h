#pragma once
// How the patches of a set are divided so that a tolerance is kept, and where their vertices and triangles lie.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "block/patch_set_impl.h"
#include "tess/cells/stitched_patch.h"
#include "tess/closing/closed_edges.h"
#include "tess/edges/shared_edges.h"
#include "tess/edges/weld.h"
#include "tess/trimmed/cut_patch.h"
#include "tessera/tessellation.h"

namespace tessera { inline namespace abi_0_1 {

inline constexpr std::uint64_t max_vertices = std::uint64_t{1} << 32;  ///< the limit of 32-bit indices
inline bool has_32_bit_indices(const MeshCapacity& size) { return std::uint64_t{size.vertices} <= max_vertices; }

/// The data that few plans have. It takes memory of its own there.
struct RarePatches {
  /// A patch of an area without triangles: opposite borders are points, and the line between them is the border of
  /// another, or a point that another has.
  struct LinePatch {
    std::uint32_t patch;
    std::uint32_t holder;  ///< a patch with triangles on that line; no_id for points
  };

  /// `[patch]`: 1 if its vertices come from the set's double control points, see F64Points; empty if no patch's do.
  /// Borders of one edge then have the same positions only after VertexCopies are made.
  std::vector<std::uint8_t> f64_patches;
  std::vector<std::uint32_t> beyond;  ///< by choose_rates(): patches whose bounds exceed the limits, by growing patch
  std::vector<LinePatch> lines;       ///< by divide_patches()

  // By FaceCutter:
  std::shared_ptr<const PatchTrims> trims;  ///< those of the set
  std::vector<CutPatch> cuts;               ///< the patches that loops cut, by growing patch
  std::vector<std::uint32_t> crossed;       ///< cut patches without triangles, because their chords cross

  std::optional<ClosedEdges> closed;  ///< by close_faces(): the vertices that faces share along edges
};

/// RarePatches, or none.
class RareSlot {
 public:
  const RarePatches* operator->() const {
    static const RarePatches none;
    return value_ ? value_.get() : &none;
  }
  RarePatches& make() {
    if (!value_) value_ = std::make_unique<RarePatches>();
    return *value_;
  }

 private:
  std::unique_ptr<RarePatches> value_;
};

/// How patches are divided, and the bounds that they keep. The stages of make_plan() fill it one after the other.
struct DividedPatches {
  // By choose_rates():
  std::vector<PatchSegments> segments = {};     ///< `[patch]`: that it needs for itself
  std::vector<float> bounds = {};               ///< `[patch]`
  std::vector<float> angles = {}, pixels = {};  ///< `[patch]`; empty if no angle, or no pixels, were set
  /// `[patch]`: 1 if its bounds hold for triangles that cross its middle, too; empty if for none.
  std::vector<std::uint8_t> crosses = {};

  // By divide_patches():
  std::vector<Division> divisions = {};  ///< `[patch]`; those of cut patches are empty but for the borders' segments
  std::uint32_t open_edges = 0;          ///< edges of triangles on borders that no other border is joined to

  bool has_f64_positions =
      false;  ///< whether the mesh has positions in double: then all RarePatches::f64_patches are 1
  RareSlot rare = {};
};

/// The divided patches of a mesh, and where its vertices and triangles lie. Borders and corners are numbered, as in
/// VertexCopies, 4 * patch + side.
class CertifiedPlan {
 public:
  explicit CertifiedPlan(DividedPatches&& patches) : patches_(std::move(patches)) { lay_out(); }

  const DividedPatches& patches() const { return patches_; }
  std::size_t patch_count() const { return patches_.divisions.size(); }
  const Division& division(std::size_t patch) const { return patches_.divisions[patch]; }
  std::span<const CutPatch> cuts() const { return patches_.rare->cuts; }
  /// The vertices that faces share along edges; null if the set has no edges.
  const ClosedEdges* closed() const { return patches_.rare->closed ? &*patches_.rare->closed : nullptr; }
  bool is_f64(std::size_t patch) const {
    return !patches_.rare->f64_patches.empty() && patches_.rare->f64_patches[patch];
  }
  /// Whether another plan has the same triangles, by the numbers of their vertices.
  bool has_triangles_of(const CertifiedPlan& other) const;
  /// Replaces the bounds of a patch, which keeps its segments; those of angles and pixels if there are any.
  void set_bounds(std::size_t patch, float bound, float angle, float pixels);

  std::size_t first_vertex(std::size_t patch) const { return first_vertex_[patch]; }
  std::size_t first_triangle(std::size_t patch) const { return first_triangle_[patch]; }
  /// In a mesh with quads, cells between inner points are quads, and first_strip() counts triangles without theirs.
  std::size_t first_quad(std::size_t patch) const { return first_quad_[patch]; }
  std::size_t first_strip(std::size_t patch) const { return first_triangle_[patch] - 2 * first_quad_[patch]; }
  MeshCapacity capacity() const { return {first_vertex_.back(), first_triangle_.back(), 0}; }

  /// Stores vertices that are copies of each other once. Ring vertices that a patch owns follow its inner points.
  void share(const VertexCopies& copies);
  bool shares_vertices() const { return !ring_sources_.empty(); }
  /// Returns the corner whose patch owns the vertex of a corner.
  std::uint32_t corner_owner(std::uint32_t corner) const {
    return shares_vertices() ? ring_sources_[corner].corner : corner;
  }
  bool owns_corner(std::size_t corner) const { return corner_owner(static_cast<std::uint32_t>(corner)) == corner; }
  /// Whether the patch owns the points inside a border.
  bool owns_border(std::size_t border) const {
    return !shares_vertices() || (ring_sources_[border].from == border && !ring_sources_[border].is_point);
  }
  /// Returns the vertex at point k = 0 .. rate of a border of a patch with an area, in the direction of the ring.
  std::size_t ring_vertex(std::uint32_t border, int k) const;

 private:
  /// Who owns the vertices of a border and of the corner at its start.
  struct RingSource {
    std::uint32_t corner;                     ///< the corner that owns the vertex at the start
    std::uint32_t from;                       ///< the border that owns the points inside
    bool reversed = false, is_point = false;  ///< a point: `from` is a corner
  };
  void lay_out();
  std::size_t owned_ring_count(std::size_t patch, std::uint32_t sides = 4) const;

  DividedPatches patches_;
  /// `[patch]`, and the number of all at the end.
  std::vector<std::size_t> first_vertex_, first_triangle_, first_quad_;
  std::vector<RingSource> ring_sources_;  ///< `[border]`: itself if it owns its vertices; empty if nothing is shared
};

constexpr bool is_backward(std::uint32_t border) { return is_backward(all_sides[border % 4]); }

}}  // namespace tessera::abi_0_1
