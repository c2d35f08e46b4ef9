#pragma once
// The state of a PointScene.

#include <optional>

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

  static constexpr std::size_t points_per_task = 256;
  /// Finds a nearest point; `search` is of this scene.
  NearestPoint nearest(const Vec3& point, double max_distance, NearestSearch& search) const;

  void keep(PatchSet&& set) { kept_.emplace(std::move(set)); }
  const SetView& set() const { return set_; }
  const QueryPieces& pieces() const { return pieces_; }
  std::uint64_t revision() const { return revision_; }
  std::size_t memory_bytes() const { return pieces_.memory_bytes(); }

 private:
  Status done(Status status);

  SetView set_;
  QueryPieces pieces_;
  std::optional<PatchSet> kept_;  ///< empty if the caller keeps it
  double size_ = 0;
  std::uint64_t revision_ = 0;
  bool ready_ = false;
};

}}  // namespace tessera::abi_0_1
