#pragma once
// The patches of one surface with all points in one array: one allocation in total instead of one per patch.

#include <algorithm>
#include <cassert>
#include <span>
#include <vector>

#include "base/saturated.h"
#include "tessera/bezier_patch.h"

namespace tessera { inline namespace abi_0_1 {

/// Patches that are filled one by one, from any number of threads, and then taken. Points and weights must be valid for
/// BezierPatch::polynomial or rational. A patch keeps its weights even if they are all equal, because rationality is a
/// property of the surface.
class PatchPieces {
 public:
  PatchPieces(int degree_u, int degree_v, std::size_t count, bool rational)
      : degree_u_(degree_u),
        degree_v_(degree_v),
        count_(count),
        size_(static_cast<std::size_t>(degree_u + 1) * static_cast<std::size_t>(degree_v + 1)),
        memory_(saturated_product(count, size_ * (sizeof(Vec3) + (rational ? sizeof(double) : 0)))),
        points_(static_cast<Vec3*>(memory_.data())),
        weights_(rational ? reinterpret_cast<double*>(points_ + count * size_) : nullptr) {}

  bool rational() const { return weights_ != nullptr; }
  Vec3* points(std::size_t patch) { return &points_[patch * size_]; }
  double* weights(std::size_t patch) { return &weights_[patch * size_]; }

  /// Returns all patches, in order.
  std::vector<BezierPatch> take() {
    std::vector<BezierPatch> patches;
    patches.reserve(count_);
    SharedMemory::Copies handles(memory_, count_);
    for (std::size_t k = 0; k < count_; ++k) patches.push_back(patch(k, handles.take()));
    return patches;
  }
  /// Makes one patch with memory of its own; without weights it is polynomial.
  static BezierPatch single(int degree_u, int degree_v, std::span<const Vec3> points, std::span<const double> weights) {
    PatchPieces piece(degree_u, degree_v, 1, !weights.empty());
    std::copy(points.begin(), points.end(), piece.points_);
    std::copy(weights.begin(), weights.end(), piece.weights_);
    return piece.patch(0, std::move(piece.memory_));
  }
  /// Gives a patch memory of its own, unless it has it already, so that overwrite() changes no other patch.
  static void make_sole(BezierPatch& patch) {
    if (!patch.memory_.sole()) patch = single(patch.degree_u(), patch.degree_v(), patch.points(), patch.weights());
  }
  /// Returns the writable points of a patch that has memory of its own. They must stay finite.
  static Vec3* sole_points(const BezierPatch& patch) {
    assert(patch.memory_.sole());
    return const_cast<Vec3*>(patch.points_);
  }
  /// Replaces the control points of such a patch: as many as before, finite.
  static void overwrite(BezierPatch& patch, const Vec3* points) {
    std::copy_n(points, patch.count(), sole_points(patch));
  }
  /// Releases the memory of all patches of a surface at once. Afterwards they can only be destroyed.
  static void release(std::span<BezierPatch> patches) {
    SharedMemory::Sink sink;
    for (BezierPatch& patch : patches) sink.take(patch.memory_);
  }

 private:
  BezierPatch patch(std::size_t k, SharedMemory memory) {
    BezierPatch patch;
    patch.degree_u_ = degree_u_;
    patch.degree_v_ = degree_v_;
    patch.points_ = points(k);
    patch.weights_ = rational() ? weights(k) : nullptr;
    patch.memory_ = std::move(memory);
    assert(is_finite(patch.points_[0]) && is_finite(patch.points_[size_ - 1]));
    return patch;
  }

  int degree_u_, degree_v_;
  std::size_t count_, size_;
  SharedMemory memory_;
  Vec3* points_;
  double* weights_;
};

}}  // namespace tessera::abi_0_1
