#pragma once
// The Bezier points of a spline surface whose control points move.

#include <cstdint>
#include <span>
#include <vector>

#include "convert/spline/spline_strips.h"

namespace tessera { inline namespace abi_0_1 {

/// Converts the patches that moved control points act on, to the same bits as to_bezier(). Holds memory for all patches
/// of the surface, so that repeated conversions allocate nothing.
class EditedSpline {
 public:
  explicit EditedSpline(const BSplineSurface& surface);
  EditedSpline(const EditedSpline&) = delete;
  EditedSpline& operator=(const EditedSpline&) = delete;

  const BSplineSurface& surface() const { return surface_; }
  std::span<const double> breaks_u() const { return rows_.u().breaks; }
  std::span<const double> breaks_v() const { return rows_.v().breaks; }
  std::size_t patch_count() const { return rows_.u().span_count() * rows_.v().span_count(); }
  std::size_t patch_points() const { return rows_.order_u() * order_v(); }  ///< control points of a patch

  /// Takes all control points, which must live until convert(). `moved`: the points i * count_v() + j that differ from
  /// those of the last call; empty: any may. Errors: count_mismatch (points), invalid_argument (no such point).
  Status move(std::span<const Vec3> points, std::span<const std::uint32_t> moved);
  /// Makes the next move() compute all points anew.
  void forget() { is_known_ = false; }
  /// Returns how many patches are affected by the moved points.
  std::size_t touched_count() const { return first_touched_.back(); }
  /// Writes these patches, as a * breaks along v + b, in order, and their points, patch after patch.
  Status convert(std::uint32_t* patches, Vec3* points, const Execution& execution);

 private:
  /// Patches [first, last) of a direction, on which a control point acts.
  struct Run {
    std::uint32_t first = 0, last = 0;
  };
  static constexpr std::size_t stack_numbers = 4096;

  std::size_t order_v() const { return static_cast<std::size_t>(surface_.degree_v()) + 1; }
  static std::vector<Run> runs_of(const KnotLine& line);
  /// Writes the touched patches of one row of patches.
  void convert_row(std::size_t a, Strip& strip, std::uint32_t* patches, Vec3* points) const;

  BSplineSurface surface_;  ///< keeps the knots and weights that rows_ refers to
  ExtractedRows rows_;
  std::vector<Run> runs_u_, runs_v_;        ///< `[i]`, `[j]`
  std::size_t strip_patches_;               ///< patches of a strip whose memory lies on the stack
  std::vector<std::uint8_t> is_touched_;    ///< `[a][b]`
  std::vector<std::size_t> first_touched_;  ///< `[a]`: touched patches before the row, and the number of all
  std::vector<std::uint8_t> is_row_moved_;  ///< `[i]`
  UnsetVector<double> numbers_;             ///< `[i][j][component]`: memory for rows that are computed
  bool is_known_ = false;                   ///< whether rows_ holds the points of the last move()
};

}}  // namespace tessera::abi_0_1
