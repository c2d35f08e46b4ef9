#pragma once
// One patch that trimming loops cut, as triangles.

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "block/patch_trims.h"
#include "plane/band_refiner.h"
#include "tess/bounds/chord_bound.h"
#include "tess/cells/stitched_patch.h"
#include "tess/trimmed/trimmed_patch.h"

namespace tessera { inline namespace abi_0_1 {

/// The triangles of a cut patch.
struct CutPatch {
  using Triangle = CutCells::Triangle;
  /// A vertex where a segment of the patch's border begins: point `at` = 0 .. rate along the border's parameter.
  struct BorderVertex {
    std::uint32_t vertex;
    std::uint16_t at;
    Side side;
  };
  /// A chord of a loop's curve, or of a line that closes a gap between two curves, and its ends.
  struct LoopSegment {
    std::uint32_t piece = 0;           ///< of the region
    std::uint32_t start = 0, end = 0;  ///< vertices; equal where rounding puts them in one place
    double from = 0, to = 0;           ///< parameters of the caller's curve
    bool has_triangle = true;          ///< false where a sliver became a line, so that none is left beside it
  };
  /// A vertex on a side, at `along`, the surface's parameter along it.
  struct SideVertex {
    std::uint32_t vertex;
    Side side;
    double along;
  };
  /// The border of a whole patch that has the same points as a side.
  struct SameBorder {
    std::uint32_t border = no_id;  ///< 4 * patch + side
    bool reversed = false;         ///< their parameters run in opposite directions
  };

  std::uint32_t patch = 0;
  bool is_crossed = false;               ///< chords still cross after all divisions, so it has no triangles
  bool has_too_many = false;             ///< it needs more triangles than allowed, so it is not whole
  std::vector<ParameterPoint> vertices;  ///< in the patch's own parameters; those of its grid come first, line by line
  /// Counter-clockwise in the parameters. The first `whole` are those of whole cells, two and two.
  std::vector<Triangle> triangles;
  std::size_t whole = 0;
  std::vector<BorderVertex> on_borders;
  /// If the loops name edges: the chords along them, and all vertices on sides, by sides and places.
  std::vector<LoopSegment> loop_segments;
  std::vector<SideVertex> side_vertices;
  std::array<bool, 4> is_full{};    ///< by Side: the loops keep all of it, and none ends on it
  std::array<bool, 4> is_shared{};  ///< by Side: not full, but a patch of another face has the same border
  std::array<SameBorder, 4> same;   ///< by Side
  /// Edges along loops, and on parts of sides that no neighbour has; where loops cross, before they are divided.
  std::uint32_t open_edges = 0;
  double distance = 0, sliver = 0;  ///< the largest distance of a triangle, and of a sliver between chords and curves
  Rates widest;                     ///< odd rates at which cells are no smaller than the box of any triangle
  std::array<std::uint32_t, 4> poles{no_id, no_id, no_id, no_id};  ///< by Side: the vertex of a collapsed border

  /// The box of a triangle's parameters. A pole has every parameter along its border, so it does not count there.
  struct Box {
    double u0 = 1, u1 = 0, v0 = 1, v1 = 0;
    double width() const { return u1 - u0; }
    double height() const { return v1 - v0; }
    double distance(const ChordBound& chord) const;
  };
  Box box_of(const Triangle& triangle) const;
  /// Calls quad({a, b, c, d}) for the cells that are whole, and triangle(Triangle) for the other triangles.
  template <class VisitQuad, class VisitTriangle>
  void for_faces(VisitQuad quad, VisitTriangle triangle) const {
    for (std::size_t k = 0; k < triangles.size(); ++k) {
      const Triangle& t = triangles[k];
      if (k + 1 < whole && is_cell(t, triangles[k + 1])) {
        ++k;
        quad(std::array{t[0], t[1], t[2], triangles[k][2]});
      } else {
        triangle(t);
      }
    }
  }
  std::size_t quad_count() const {
    std::size_t count = 0;
    for_faces([&](const auto&) { ++count; }, [](const auto&) {});
    return count;
  }
  /// Whether two triangles are the halves of a box of parameters, with the diagonal from the first corner of both.
  bool is_cell(const Triangle& first, const Triangle& second) const;
  /// Extends `distance` and `widest` to a triangle.
  void measure(const Triangle& triangle, const ChordBound& chord);
};

/// Finds the record of a patch among those that are cut, by growing patch; null if it is none of them.
template <class T>
T* find_cut(std::span<T> cuts, std::uint32_t patch) {
  const auto cut = std::ranges::lower_bound(cuts, patch, {}, &CutPatch::patch);
  return cut != cuts.end() && cut->patch == patch ? &*cut : nullptr;
}

/// The sides of all patches of a face.
struct FaceSides {
  FaceSides() = default;
  explicit FaceSides(const TrimRegion& region);
  PatchSides u, v;  ///< lines u = const; lines v = const
};

/// Cuts patches, one after the other. An object serves one thread at a time.
class CutPatchMaker {
 public:
  /// Cuts a patch. `cut`: the patch, of this region. `limits.domain` is set here. `borders`: the segments of its sides.
  /// `out.patch` and `out.same` are the caller's, the rest is written.
  ///
  /// Where chords cross, they are made finer, to a 64th; if they still cross then, the first ones are divided where
  /// they do. The bound of slivers holds for either.
  /// If cancelled, it stops early: what it wrote is then of no use.
  void make(const TrimRegion& region, const FaceSides& sides, const PatchTrims::Cut& cut, TrimmedPatch limits,
            const std::array<Segments, 4>& borders, SideMask collapsed, const ChordBound& chord, CutPatch& out);

 private:
  bool run(const TrimRegion& region, const FaceSides& sides, std::size_t place, const TrimmedPatch& limits,
           const std::array<Segments, 4>& borders, CutPatch& out);
  void number(SideMask collapsed, bool names_edges, CutPatch& out);
  /// Lists the edges of triangles along loops, and counts them instead of the chords as they were laid.
  void list_loop_segments(CutPatch& out);
  /// Halves the triangles of the band that are too large. Returns false if there would be too many.
  bool refine(const TrimmedPatch& limits, const ChordBound& chord, CutPatch& out);
  /// Merges vertices that rounding puts in one place, and leaves out the triangles between them.
  void merge(const TrimmedPatch& limits, CutPatch& out);
  /// Finds the segments of loops that are edges of one triangle.
  static void mark_loop_segments(CutPatch& out);
  /// Leaves out vertices that others replace. `kept`: by vertex, the one that stays.
  void compact(std::span<const std::uint32_t> kept, CutPatch& out);
  void measure(PatchSegments segments, const ChordBound& chord, CutPatch& out);
  void find_border_vertices(const std::array<Segments, 4>& borders, const Domain& domain, bool all, CutPatch& out);

  PatchCutter cutter_;
  std::vector<std::uint32_t> numbers_;  ///< by vertex of the cutter
  std::vector<ParameterPoint> points_;  ///< by vertex of the patch, in the surface's parameters
  std::vector<double> lines_;
  std::size_t band_ = 0;      ///< the first triangle of the band
  std::uint32_t chords_ = 0;  ///< along loops, as they were laid
  BandRefiner refiner_;
  VertexMerger merger_;
};

}}  // namespace tessera::abi_0_1
