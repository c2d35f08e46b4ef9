#pragma once
// The inner state of a TrimRegion, for the floors that mesh what it keeps.

#include <cstdint>
#include <span>
#include <vector>

#include "base/internal_export.h"
#include "tessera/trim_region.h"
#include "trim/curve_extractions.h"
#include "trim/cut_lines.h"
#include "trim/region_cells.h"
#include "trim/trim_piece.h"

namespace tessera { inline namespace abi_0_1 {

class TrimRegion::Impl {
 public:
  /// What a region is made for. Cells take about as long as all the rest, and meshes need none.
  enum class Use {
    points,   ///< locate() too
    patches,  ///< all but locate(): `cells` stays empty
  };
  /// `shared`: extractions of curves that regions share; null: none.
  static Result<TrimRegion> make(std::span<const TrimLoop> loops, std::span<const double> breaks_u,
                                 std::span<const double> breaks_v, const TrimOptions& options, Use use,
                                 CurveExtractions* shared = nullptr);
  static Result<TrimRegion> make(std::span<const TrimLoop> loops, const PatchGrid& grid, Use use);
  /// Returns the region, made for points.
  TESSERA_INTERNAL_EXPORT static TrimRegion for_points(const TrimRegion& region);
  /// How loops over a grid are repaired.
  static TrimOptions options_of(const PatchGrid& grid);

  CutLines lines;
  Domain domain;
  /// Pieces between patch borders, in which an even number of ends meet at every point. Those of a loop stand in its
  /// order, those along the sides of the domain last.
  std::vector<TrimPiece> pieces;
  bool starts_inside = false;  ///< whether points that no piece encloses are kept
  RegionCells cells;
  std::vector<TrimSide> patches;  ///< `[a][b]`
  /// Those of patch `[a][b]`, at place k, are cutting[first_cutting[k]] to cutting[first_cutting[k + 1]].
  std::vector<std::uint32_t> cutting, first_cutting;
  bool is_whole = true;
  ParameterPoint band;
  std::vector<LoopRemark> remarks;

  /// The patches along v.
  std::size_t count_v() const { return lines.v.lines.size() - 1; }
  /// The pieces that cut a patch, as indices into `pieces`. Those along its sides do not.
  std::span<const std::uint32_t> pieces_of(std::size_t place) const {
    return std::span(cutting).subspan(first_cutting[place], first_cutting[place + 1] - first_cutting[place]);
  }
};

}}  // namespace tessera::abi_0_1
