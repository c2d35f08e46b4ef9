#pragma once
// The search for the nearest point of all pieces, with none missed.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

#include "query/query_pieces.h"
#include "ray/line/set_view.h"

namespace tessera { inline namespace abi_0_1 {

/// A point of a patch that may be the nearest, relative to the frame's centre in the model's unit.
struct NearCandidate {
  std::uint32_t patch = no_id;
  double u = 0, v = 0;
  Vec3 position;
  double distance = infinity;
  bool on_border = false;    ///< as Foot::on_border
  bool is_exact = true;      ///< no step of Newton's method is left
  bool is_on_curve = false;  ///< of what bounds the kept part
};

/// The search of one point after the other, on one thread.
class NearestSearch {
 public:
  /// Refers to both.
  NearestSearch(const SetView& set, const QueryPieces& pieces);

  /// The result for a point.
  struct Outcome {
    NearCandidate best;    ///< patch no_id: nothing within the distance
    bool complete = true;  ///< no point of a piece is nearer by more than slack
    bool ambiguous = false;
    double slack = 0;  ///< rounding, in the model's unit
    int parts = 0;     ///< the work: pieces, curves and parts of them
  };
  /// `path`: that of a finite point in the scene's coordinates, begun in the pieces' tree, and used up. `point`: the
  /// same in the model's. `max_distance`: at least 0, perhaps infinite.
  Outcome run(QueryTree::Path& path, const Vec3& point, double max_distance);
  /// Finds the nearest points of the `count` nearest patches, at least 1. `best` stays empty.
  Outcome run_patches(QueryTree::Path& path, const Vec3& point, double max_distance, std::size_t count);
  /// Finds all places of patches within a distance, each once: places of one patch count as one if they are nearer to
  /// each other than four times that. `best` stays empty.
  Outcome run_all(QueryTree::Path& path, const Vec3& point, double distance);
  /// Returns what run_all() has found, by patches and parameters, or run_patches(), the nearest first.
  std::span<const NearCandidate> places() const { return places_; }

  /// The limit of work for one point. Where the surface is as far away over an area, as at the middle of a sphere, no
  /// search ends before.
  static constexpr int max_parts = 2000;
  /// The work that a piece or a curve gets before each of them was looked at; together they get a quarter of all. Where
  /// the surface is as far away along a curve, as from the axis of a rotation or the middle of an arc, those that are
  /// not the nearest would take all of it.
  static constexpr int first_parts = 48;
  /// The limit of work is larger if several patches are wanted.
  static constexpr int parts_per_patch = 64;
  static constexpr std::size_t max_patches = 1 << 20;

 private:
  friend class QueryTree;
  struct Part {
    PatchPart area;
    double lower;  ///< bounds the distance, in the scene's coordinates
    PieceBounds bounds;
  };

  double reach() const { return reach_; }
  SecondOrderPatch ground(std::uint32_t patch) const {
    return {&set_.patch(patch), pieces_.frame().centre, &pieces_.kernels().nearest};
  }
  bool visit(std::uint32_t item, double distance);
  bool branch(const QueryPiece& piece, double lower, int parts);
  bool may_be_nearer(const QueryPiece& piece, const PatchPart& area, double lower);
  template <class T>
  void halve(const QueryPiece& piece, const PatchPart& area, const PieceFacts<T>& facts);
  bool search_curve(const KeptCurve& curve, int parts);
  bool search_item(std::uint32_t item, double lower, int parts);
  void start(const Vec3& point, double max_distance);
  void search(QueryTree::Path& path);
  void polish(NearCandidate& candidate) const;
  double limit(std::uint32_t patch) const;
  void add_place(const NearCandidate& candidate);
  void add_patch(const NearCandidate& candidate);
  bool is_same_place(const NearCandidate& a, const NearCandidate& b) const;
  void push(const QueryPiece& piece, const PatchPart& area);
  template <class T>
  bool is_decided(const QueryPiece& piece, const PatchPart& area, const PieceFacts<T>& facts);
  void offer(const QueryPiece& piece, const Foot& foot);
  void offer(const NearCandidate& candidate);
  bool is_kept(std::uint32_t patch, double u, double v) const;
  bool is_cut_away(const QueryPiece& piece, const PatchPart& area) const;

  const SetView& set_;
  const QueryPieces& pieces_;
  NetParts nets_;
  std::uint32_t patch_of_nets_ = no_id;
  std::vector<Part> stack_;
  /// A piece or a curve that is not decided yet: a cut piece, or one that took more than first_parts.
  struct Deferred {
    std::uint32_t item;
    double lower;  ///< bounds its distance, in the scene's coordinates
  };
  std::vector<Deferred> deferred_;
  Vec3 point_;        ///< relative to the frame's centre, in the model's unit
  Vec3 scene_point_;  ///< in the scene's coordinates
  double reach_ = 0;  ///< in the scene's coordinates: pieces beyond are of no use
  Outcome outcome_;
  enum class Wanted : std::uint8_t { nearest, all_places, patches };
  Wanted wanted_ = Wanted::nearest;
  std::size_t patches_wanted_ = 0;
  int parts_allowed_ = max_parts;
  std::vector<NearCandidate> places_, found_places_;  ///< unless only the nearest is wanted
  static constexpr std::size_t max_ties = 4;
  std::array<NearCandidate, max_ties> ties_;
  std::size_t tie_count_ = 0;
};

}}  // namespace tessera::abi_0_1
