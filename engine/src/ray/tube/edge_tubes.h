#pragma once
// Tubes around the edges of shapes: where faces along an edge fail to meet, a ray may pass between them.
//
// Let C be the longest curve that a face has along an edge. For the curve F of each face there, with the lines that
// close its gaps, let p map the edge's parameters of F to those of C: continuously, and ends to ends. Let g be a bound
// on the distance of F(s) from C(p(s)). Segments between these points fill the slits between the faces, since C after p
// covers C once, and lie in the tube of radius g about C. At a vertex, triangles from the end of one C to the ends of
// these segments fill what is left, within a ball that the tube of this C holds too. Faces, segments and triangles
// together are a closed cycle for a closed shell. So a ray that stays out of all tubes meets the faces of a closed
// shell an even number of times, and an odd number of times between an inside and an outside point.
//
// Any p does. At the samples of F it is the parameter of C's nearest point, found from equal parameters on, and in
// between it is linear: faces may run along an edge at different paces. Where a curve has a gap that no line closes, p
// stands still at its end.
//
// g is twice what samples show: it is not proven.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ray/border/lazy_adjacency.h"
#include "ray/line/ray_query.h"
#include "ray/tube/edge_curves.h"
#include "tessera/execution.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// A part of a curve along an edge that is nearly straight.
struct TubeChord {
  const TrimPiece* piece = nullptr;
  std::uint32_t patch = 0;
  std::uint32_t stretch = 0;  ///< index into the edge's curve
  double from = 0, to = 1;    ///< of the piece, 0 to 1; the edge's parameter grows from `from` to `to`
  Vec3 start, end;            ///< the points there
  double off = 0;             ///< the curve's distance from the line between them, as sampled
};

/// Where a curve along an edge ends.
struct EdgeEnd {
  std::uint32_t vertex = no_id;
  std::uint32_t edge = 0;
  bool at_start = false;   ///< of the edge
  bool is_centre = false;  ///< whether the edge's tube is about this curve
  Vec3 position;
  double unsure = 0;
};

/// Primitives of the tree beside leaves. Const calls from any number of threads.
class EdgeTubes {
 public:
  /// Makes the tubes of a set's edges. `least`: the radius of a tube whose faces meet. Errors: cancelled,
  /// out_of_memory.
  Status build(const SetView& set, const SceneFrame& frame, const LazyAdjacency& borders, double least,
               const Execution& execution);
  /// Measures the edges of these patches again. Returns false if other edges need tubes now: then they must be built.
  /// Errors: as above.
  Result<bool> update(std::span<const std::uint32_t> patches, const LazyAdjacency& borders, double least,
                      const Execution& execution);
  void clear() { *this = {}; }

  std::size_t count() const { return tubes_.size(); }
  const Box3& box(std::size_t tube) const { return tubes_[tube].box; }
  std::uint32_t patch(std::size_t tube) const { return chords_[tubes_[tube].first].patch; }
  /// Returns the largest radius.
  double largest_gap() const;
  /// Returns the largest radius of each edge's tubes, in the model's unit; 0 for an edge without tubes.
  std::vector<double> gaps() const;

  /// Adds the nearest point of a tube's curve to the query, if the ray passes within the tube and does not begin there.
  /// If all roots are wanted, notes the gap instead.
  void search(unsigned tube, RayQuery& query) const;
  std::size_t memory_bytes() const {
    return chords_.capacity() * sizeof(TubeChord) + tubes_.capacity() * sizeof(Tube) +
           measured_.capacity() * sizeof(double) + ends_.capacity() * sizeof(EdgeEnd);
  }

 private:
  struct Tube {
    std::uint32_t edge, first, count;  ///< chords
    double gap;
    Box3 box;
  };
  struct EdgeParts;
  bool needs_tube(std::size_t edge, const LazyAdjacency& borders) const;
  EdgeParts parts_of(std::size_t edge) const;
  void cut(const EdgeStretch& stretch, std::uint32_t index, double from, double to, int depth,
           std::vector<TubeChord>& chords) const;
  void place(const EdgeStretch& stretch, TubeChord& chord) const;
  void measure(std::size_t edge, std::span<const EdgeCurve> curves, std::span<const TubeChord> chords,
               std::span<double> measured) const;
  void add_ends(std::size_t edge, std::span<const EdgeCurve> curves, std::vector<EdgeEnd>& ends) const;
  void add_lines(std::size_t edge, std::span<const EdgeCurve> curves, std::vector<EdgeEnd>& ends) const;
  void group();
  void set_gaps(double least);
  void hold_vertices(double least);

  std::optional<EdgeCurves> curves_;
  const SetView* set_ = nullptr;
  SceneFrame frame_;
  std::vector<TubeChord> chords_;           ///< edge by edge, by growing parameters
  std::vector<std::uint32_t> first_chord_;  ///< by edge, and the number of all
  std::vector<double> measured_;            ///< by chord: the largest distance of the faces' points there
  std::vector<std::vector<EdgeEnd>> ends_;  ///< by edge; at the end, of lines that belong to no edge
  std::vector<Tube> tubes_;                 ///< edge by edge
};

}}  // namespace tessera::abi_0_1
