#pragma once
// Brings what searches begin with into the caches while other searches run: memory takes longer than a search.

#include <array>
#include <cstddef>
#include <cstdint>

#include "query/query_pieces.h"
#include "ray/line/set_view.h"

namespace tessera { inline namespace abi_0_1 {

/// The beginnings of searches of one point after the other. A point gets four steps, each of which needs what the one
/// before has asked for: the nearest block of the tree, the nearest piece in it, the piece's patch, its control points.
class FetchAhead {
 public:
  /// Between two steps of a point, `gap` other points have theirs.
  static constexpr std::size_t gap = 4, steps = 4, most_ahead = gap * (steps - 1);

  /// Refers to both.
  FetchAhead(const SetView& set, const QueryPieces& pieces) : set_(set), pieces_(pieces) {}

  /// Takes the first step of point k, in the scene's coordinates, and one of each that is a gap further. Points follow
  /// each other from 0.
  void push(std::size_t k, const Vec3& point) {
    pushed_ = k + 1;
    pieces_.tree().begin(pieces_.kernels().nearest, point, at(k).path);
    advance(k);
  }
  /// Goes on as if a point k were pushed, after the last one.
  void advance(std::size_t k) {
    const auto has = [&](std::size_t back) { return k >= back && k - back < pushed_; };
    if (has(gap)) fetch_piece(at(k - gap));
    if (has(2 * gap)) fetch_patch(at(k - 2 * gap));
    if (has(3 * gap)) fetch_points(at(k - 3 * gap));
  }
  /// Returns the search of a point.
  QueryTree::Path& path(std::size_t k) { return at(k).path; }

 private:
  struct Entry {
    QueryTree::Path path;
    const QueryPiece* piece = nullptr;
  };
  static constexpr std::size_t entries = 16;
  static_assert(most_ahead < entries);
  Entry& at(std::size_t k) { return ring_[k % entries]; }

  void fetch_piece(Entry& entry) const {
    entry.piece = nullptr;
    const std::uint32_t item = pieces_.tree().nearest_item(entry.path);
    if (item >= pieces_.pieces().size()) return;  // a curve, or none
    entry.piece = &pieces_.pieces()[item];
    fetch(entry.piece, sizeof(QueryPiece));
  }
  void fetch_patch(const Entry& entry) const {
    if (!entry.piece) return;
    fetch(&set_.patch(entry.piece->patch), sizeof(BezierPatch));
    fetch(&set_.source(entry.piece->patch), sizeof(PatchSource));
  }
  void fetch_points(const Entry& entry) const {
    if (!entry.piece) return;
    const auto points = set_.patch(entry.piece->patch).points();
    fetch(points.data(), points.size_bytes());
  }

  const SetView& set_;
  const QueryPieces& pieces_;
  std::size_t pushed_ = 0;
  std::array<Entry, entries> ring_;
};

}}  // namespace tessera::abi_0_1
