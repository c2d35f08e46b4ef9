#pragma once
// Proves a plan again after edits, from the edited patches alone, and finds which patches need other segments.

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "base/function_ref.h"
#include "tess/plan/certified_plan.h"
#include "tess/plan/plan_facts.h"

namespace tessera { inline namespace abi_0_1 {

/// A plan and the set that it is proven for.
struct PlanOfSet {
  const PatchSet::Impl& set;
  const CertifiedPlan& plan;
  const VertexCopies& weld;   ///< vertices with a common position
  const VertexCopies& joins;  ///< vertices with a common normal, or stored once
  double tolerance;           ///< the distance, infinite if there is no limit
  double spare;               ///< see KeptSegments
  double headroom;            ///< see PlanRequest
};

/// The bounds of all patches of a set, kept for edits. Holds memory for all patches, so that repeated proofs of
/// distances allocate nothing. Edges and welds are those of the facts.
class PlanUpdate {
 public:
  PlanUpdate(PlanFacts facts, const PlanOfSet& of);

  const PlanFacts& facts() const { return facts_; }
  /// Whether the borders of each edge are one still.
  bool borders_hold() { return facts_.borders.follow(facts_.needs); }

  /// Forgets the patches of the last proof.
  void begin();
  /// Begins with a new view, for which all patches are proven anew.
  void begin(const Camera& view);
  /// Adds a patch that has new control points, or will have them when its block is packed.
  void touch(const PatchSet::Impl& set, std::size_t patch);
  std::span<const std::uint32_t> blocks() const { return touched_.blocks; }  ///< blocks with touched patches
  bool is_touched(const PatchSet::Impl& set, std::size_t patch) const { return touched_.has(set.slots[patch]); }

  enum class Outcome : std::uint8_t {
    kept,       ///< the plan's segments keep the tolerances
    redivided,  ///< some patches need other segments
    unknown,    ///< only new facts can tell: shapes, the source of vertices or welds must change, or nothing suffices
  };
  /// Proves the touched patches and those that take vertices from them, or all for a new view. `pack`: packs the new
  /// control points of a block; called from any thread, once for each block of touched patches. Errors: cancelled.
  Result<Outcome> prove(const PlanOfSet& of, FunctionRef<void(std::uint32_t block)> pack, const Execution& execution);
  /// After `kept`: sets the new bounds.
  void take_bounds(CertifiedPlan& plan) const;
  /// After `redivided`: returns the plan with the new segments. Vertices are not shared yet.
  CertifiedPlan redivided(const PlanOfSet& of) const;

 private:
  /// Patches by their place in blocks.
  struct Lanes {
    std::vector<std::uint32_t> bits;    ///< `[block]`: one bit per lane
    std::vector<std::uint32_t> blocks;  ///< blocks with a bit
    explicit Lanes(std::size_t count) : bits(count, 0) { blocks.reserve(count); }
    bool has(PatchSet::Slot slot) const { return bits[slot.block] >> slot.lane & 1u; }
    void add(PatchSet::Slot slot);
    void clear();
  };
  /// The segments and limits of a patch that has been proven.
  struct Proven {
    PatchSegments segments;
    bool anywhere = false;  ///< see ProvenSegments
    float bound = 0, angle = 0, pixels = 0;
  };

  /// Whether a patch without triangles, or the neighbour whose triangles stand for it, is touched, or may be.
  bool moves_line_patches(const PlanOfSet& of) const;
  void bound_block(const PlanOfSet& of, std::uint32_t block);
  bool has_copies() const { return !displacements_.empty(); }
  /// Finds the patches whose copied vertices have moved, and how far they lie from their surfaces.
  void measure_copies(const PlanOfSet& of);
  void choose(const PlanOfSet& of, std::uint32_t block, std::uint32_t wanted);
  void choose_by_distance(const PlanOfSet& of, std::uint32_t block, std::uint32_t wanted);
  void set(const PlanOfSet& of, std::size_t patch, const Proven& proven);
  /// Returns the chord distance of triangles at borders of odd rates beside even ones; 0 if there are none.
  double crossing_distance(const PlanOfSet& of, std::size_t patch) const;
  template <class Visit>
  static void for_lanes(const PatchSet::Impl& set, const Lanes& lanes, Visit visit);
  template <class Visit>
  void for_proven(const PatchSet::Impl& set, Visit visit) const;

  PlanFacts facts_;
  Lanes touched_;
  Lanes copied_;                       ///< touched patches, and those that copy vertices; unused without copies
  std::vector<double> own_roundings_;  ///< `[patch]`: roundings of its vertices before welding; empty without copies
  std::vector<double> displacements_;  ///< `[patch]`: how far copies move its vertices; empty without copies
  std::vector<Proven> proven_;         ///< `[patch]`, of those that were proven last
  bool is_view_new_ = false;           ///< whether all patches are proven
  std::atomic<bool> is_redivided_ = false, is_unknown_ = false;
};

}}  // namespace tessera::abi_0_1
