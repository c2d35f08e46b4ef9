#pragma once
// Plans the patches that trimming loops cut, together with their neighbours.
//
// Proof of the bound of a cut patch:
// 1. A triangle with its corners on a patch lies within f of it: tess/bounds/chord_bound.h, by its own parameter box.
//    Each point of the triangle is near a point of the patch at parameters in the triangle, and the other way round.
// 2. The triangles cover the polygon of the chords, once: PolygonTriangles, by exact signs.
// 3. A point of the polygon outside of the loops lies in a sliver between a chord and its curve. So does a point
//    within the loops outside of the polygon. Both are within e of a point on the other's border: PieceChords.
// 4. Vertices are moved by at most r: by rounding, or by taking the vertices of a whole neighbour. So the bound is
//    f + e + r, each its largest.
//
// Angles and pixels hold as for whole patches, at rates whose cells are as wide as the widest triangle.

#include <cstdint>
#include <optional>
#include <vector>

#include "parallel/workspaces.h"
#include "tess/closing/edge_stations.h"
#include "tess/plan/certified_plan.h"
#include "tess/plan/cut_shares.h"
#include "tess/plan/plan_facts.h"

namespace tessera { inline namespace abi_0_1 {

/// Cuts the patches of a set until every bound holds or no attempt helps.
class FaceCutter {
 public:
  /// The set must have trims. All must outlive this object. `patches`: their rates are chosen.
  FaceCutter(const PlanFacts& facts, const PlanRequest& request, DividedPatches& patches, const Execution& execution);

  /// Chooses the segments of cut patches, divides all patches and cuts those that are due or changed. Errors:
  /// invalid_argument (more triangles than the limit), cancelled.
  Status cut();
  /// The stations by which the patches were cut; null if edges of shapes stay open.
  const EdgeStations* stations() const { return stations_ ? &*stations_ : nullptr; }
  /// Sets the bounds of a cut patch, place `c` among the cuts, whose triangles have been divided. Returns the largest
  /// over its limit.
  double bound_edited(std::size_t c);
  /// Marks a patch to be cut anew, for this part of the tolerance that it had.
  void cut_again(std::size_t c, double factor);

 private:
  /// The room for the triangles of a cut patch, and for the slivers along its loops.
  struct Room {
    double given = 0;  ///< the errors of its vertices and of the fit
    double tolerance = 0;
    TrimmedPatch limits;
  };

  /// `share`: the part of the tolerance that the patch may take.
  Room room_of(const CutPatch& cut, double share) const;
  /// Sets the bounds of a patch that has been cut. Returns the largest over its limit.
  double bound(const Room& room, const CutPatch& cut);
  /// Finds the borders of whole patches along the sides of cut ones.
  void find_same_borders();
  /// Makes one attempt of cut().
  Status cut_once();
  /// Chooses the segments of the cut patches that are to be cut anew, for their shares of the room.
  void choose_segments();
  /// Divides all patches. Returns `[patch]`: 1 if the patch is divided otherwise than before, or due.
  std::vector<std::uint8_t> divide();
  /// Finds the rooms of all cut patches, as patches are divided now. Errors: cancelled.
  Status find_rooms();
  /// Finds what chords along edges must keep for the faces on both sides, as patches are divided now. Edges without a
  /// changed patch keep their stations. Marks the patches along edges whose stations change as changed, too.
  Status find_stations(std::vector<std::uint8_t>& is_changed);
  /// Cuts a patch and sets its bounds. Returns the largest over its limit.
  double cut_patch(std::size_t c, CutPatchMaker& maker);
  /// Refuses cut patches that have more triangles than the limit.
  Status check_triangles() const;
  /// Counts the edges of a mesh with cut patches.
  void count_open_edges();

  const PlanFacts& facts_;
  const PatchSet::Impl& set_;
  const PlanRequest& request_;
  DividedPatches& patches_;
  RarePatches& rare_;                    ///< those of patches_
  Execution quiet_;                      ///< the caller's flag to cancel alone
  std::vector<std::uint8_t> is_shared_;  ///< `[edge]`: whether two borders or more have it
  std::vector<double> parts_;            ///< by cut patch: the part of the tolerance that it may take
  CutShares shares_;
  std::vector<double> excess_;  ///< by cut patch: its largest bound over the limit
  std::vector<Room> rooms_;     ///< by cut patch
  std::optional<EdgeStations> stations_;
  Workspaces<CutPatchMaker> makers_;
};

}}  // namespace tessera::abi_0_1
