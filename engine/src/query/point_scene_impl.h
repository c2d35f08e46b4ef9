#pragma once
// The state of a PointScene.

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "parallel/caller_arena.h"
#include "parallel/parallel_for.h"
#include "query/fetch_ahead.h"
#include "query/nearest_search.h"
#include "query/query_pieces.h"
#include "tessera/nearest_points.h"

namespace tessera { inline namespace abi_0_1 {

class PointScene::Impl {
 public:
  explicit Impl(const PatchSet& set) : set_(set) {}

  /// Builds the scene for the current set, anew or from what stands. After an error it stays stale.
  Status build(const Execution& execution);
  Status refit(const Execution& execution);
  bool fresh() const { return ready_ && revision_ == set_.revision(); }

  /// Errors: stale.
  Status check_fresh() const;

  /// Calls find(k, search, path) for the points position(k), in tasks; in each, those that lie together one after the
  /// other. Errors: cancelled, which is seen between points, because some take long.
  template <class Position, class Find>
  Status for_points(std::size_t count, const Execution& execution, const Position& position, const Find& find) const;
  /// Finds a nearest point; `search` and `path` are of this scene.
  NearestPoint nearest(const Vec3& point, double max_distance, NearestSearch& search, QueryTree::Path& path) const;
  /// Fills `nearest` with the nearest points of as many patches.
  void nearest_patches(const Vec3& point, double max_distance, NearestSearch& search, QueryTree::Path& path,
                       std::span<NearestPoint> nearest) const;
  /// The places of a point, one of most.
  struct Places {
    bool has_first = false;
    NearestPoint first;
    std::vector<NearestPoint> others;
  };
  /// Finds all places within a distance; `places` must be empty.
  void find_places(const Vec3& point, double distance, NearestSearch& search, QueryTree::Path& path,
                   Places& places) const;
  double size() const { return size_; }

  void keep(PatchSet&& set) { kept_.emplace(std::move(set)); }
  const SetView& set() const { return set_; }
  const QueryPieces& pieces() const { return pieces_; }
  std::uint64_t revision() const { return revision_; }
  std::size_t memory_bytes() const { return pieces_.memory_bytes(); }

 private:
  bool is_valid(const Vec3& point) const;
  NearestPoint point_of(const NearCandidate& candidate, const NearestSearch::Outcome& found) const;
  Status done(Status status);

  SetView set_;
  QueryPieces pieces_;
  std::optional<PatchSet> kept_;  ///< empty if the caller keeps it
  double size_ = 0;
  std::uint64_t revision_ = 0;
  bool ready_ = false;
};

/// Interleaves the bits of three numbers of 10 bits (Morton 1966).
inline std::uint32_t morton_key(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  const auto spread = [](std::uint32_t k) {
    k = (k | k << 16) & 0x030000ff, k = (k | k << 8) & 0x0300f00f;
    k = (k | k << 4) & 0x030c30c3;
    return (k | k << 2) & 0x09249249;
  };
  return spread(x) << 2 | spread(y) << 1 | spread(z);
}

template <class Position, class Find>
Status PointScene::Impl::for_points(std::size_t count, const Execution& execution, const Position& position,
                                    const Find& find) const {
  // The more points lie together, the more of what they need is in the caches.
  constexpr std::size_t fewest = 1024, most = 65536, tasks_per_thread = 2;
  const auto threads = static_cast<std::size_t>(arena_threads());
  const std::size_t points_per_task = std::clamp(count / (tasks_per_thread * threads), fewest, most);
  constexpr double cells = 1023;
  const SceneFrame& frame = pieces_.frame();
  const auto cell = [](double x) { return static_cast<std::uint32_t>(cells * std::clamp(0.5 + 0.5 * x, 0.0, 1.0)); };
  const auto is_cancelled = [&] { return execution.cancel && execution.cancel->load(std::memory_order_relaxed); };
  const auto find_task = [&](std::size_t begin, std::size_t end) {
    NearestSearch search(set_, pieces_);
    FetchAhead ahead(set_, pieces_);
    std::vector<std::uint64_t> order(end - begin);  // the key, and the place
    for (std::size_t k = begin; k < end; ++k) {
      const Vec3 at = frame.to_scene(position(k));
      const std::uint64_t key = is_finite(at) ? morton_key(cell(at.x), cell(at.y), cell(at.z)) : 0;
      order[k - begin] = key << 32 | (k - begin);
    }
    const std::size_t size = end - begin;
    std::sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(size));
    const auto place = [&](std::size_t k) { return begin + static_cast<std::uint32_t>(order[k]); };
    for (std::size_t k = 0; k < size + FetchAhead::most_ahead && !is_cancelled(); ++k) {
      if (k < size)
        ahead.push(k, frame.to_scene(position(place(k))));
      else
        ahead.advance(k);
      if (k < FetchAhead::most_ahead) continue;
      const std::size_t now = k - FetchAhead::most_ahead;
      find(place(now), search, ahead.path(now));
    }
  };
  Status status = parallel_for(count, points_per_task, execution, find_task);
  return status.ok() && is_cancelled() ? Status(StatusCode::cancelled, "cancelled by the caller") : status;
}

}}  // namespace tessera::abi_0_1
