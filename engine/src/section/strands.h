#pragma once
// The section of one patch with one plane as strands: chains of points from border to border, or closed.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "section/height_patch.h"
#include "section/loop_lines.h"
#include "section/patch_arcs.h"
#include "tessera/sections.h"

namespace tessera { inline namespace abi_0_1 {

/// A patch that planes meet, prepared for all of them.
struct PreparedPatch {
  std::uint32_t patch = 0;
  Domain domain;                         ///< in the parameters of its surface
  double low = 0, high = 0;              ///< heights
  std::array<std::uint32_t, 4> borders;  ///< numbers of its sides' lines
  HeightPatch points;
  PatchCells cells;
  std::optional<LoopLines> loops = {};  ///< if loops cut it
};

/// Where a strand ends.
struct StrandEnd {
  enum class On : std::uint8_t { nothing, border, loop };
  On on = On::nothing;
  Side side{};                 ///< of the patch, if on a border
  std::uint32_t line = 0;      ///< number of the border's line, or the piece of the face's region
  std::uint32_t interval = 0;  ///< of the line
  double place = 0;            ///< the patch's parameter along the side from 0 to 1, or the place of the piece
};

struct Strand {
  std::uint32_t patch = 0;
  bool closed = false;  ///< then the last point is the first
  std::size_t first = 0, count = 0;
  std::array<StrandEnd, 2> ends = {};
  double bound = 0;  ///< the largest distance of a chord
};

/// Traces one patch after the other; keeps its memory.
class StrandTracer {
 public:
  explicit StrandTracer(const Levels& levels) : levels_(levels) {}

  /// Appends the strands of a patch and their points.
  void trace(const PreparedPatch& patch, const Level& level, std::vector<SectionPoint>& points,
             std::vector<Strand>& strands);
  /// Whether the last patch has a place that lies in the plane, so that the limits from both sides may differ.
  bool is_special() const { return is_special_; }
  /// The cells of the last call.
  const PatchArcs& arcs() const { return arcs_; }
  /// Whether strands have lost points, because there would be more than Levels::max_points.
  bool is_full() const { return is_full_; }

 private:
  /// A point where one part of a chain ends and the next begins.
  struct Stop {
    ParameterPoint at;
    std::uint32_t arc;               ///< that the following part belongs to
    std::uint32_t crossing = no_id;  ///< that it is
    std::uint32_t hit = no_id;       ///< of a loop, that it is
  };
  struct ArcHit {
    std::uint32_t arc, hit;
    double along;
  };
  bool is_over_u(const CellNode& cell, const CellArc& arc) const;
  const CellNode& cell_of(std::uint32_t arc) const { return patch_->cells.nodes()[arcs_.arcs()[arc].cell]; }
  void attach_hits();
  double distance_to(std::uint32_t arc, const ParameterPoint& at, double& along) const;
  void follow(std::uint32_t crossing, std::uint32_t arc);
  void append_stops(std::uint32_t from, std::uint32_t arc);
  void split_chain(bool closed);
  void find_kept(std::span<const std::size_t> marks);
  TrimSide side_of(std::size_t stop) const;
  TrimSide side_beside(const ParameterPoint& at) const;
  HeightPoint between(std::size_t stop, double share, double guess) const;
  void emit(std::size_t first, std::size_t last, bool closed);
  double append_part(std::size_t stop);
  StrandEnd end_at(const Stop& stop) const;
  void append_point(const Vec3& position, const ParameterPoint& at);

  const Levels& levels_;
  const PreparedPatch* patch_ = nullptr;
  Level level_{};
  bool is_full_ = false, is_special_ = false;
  std::vector<SectionPoint>* points_ = nullptr;
  std::vector<Strand>* strands_ = nullptr;
  PatchArcs arcs_;
  std::vector<std::uint8_t> is_done_;  ///< by arc
  std::vector<LoopHit> hits_;
  std::vector<ArcHit> arc_hits_;
  std::vector<Stop> stops_;
  std::vector<std::size_t> marks_;
  std::vector<TrimSide> kept_;  ///< between marks
};

}}  // namespace tessera::abi_0_1
