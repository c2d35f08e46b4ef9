#pragma once
// The patches of one surface, with all their points in one array: one allocation instead of one a patch.

#include <cassert>
#include <memory>
#include <vector>

#include "tessera/bezier_patch.h"

namespace tessera {

/// Filled patch by patch, then taken. What is written must be what BezierPatch::polynomial and rational accept; weights
/// are kept even where those of a patch are all equal, for rationality is the surface's own.
class PatchPieces {
 public:
  PatchPieces(int degree_u, int degree_v, std::size_t count, bool rational)
      : degree_u_(degree_u),
        degree_v_(degree_v),
        count_(count),
        size_(static_cast<std::size_t>(degree_u + 1) * static_cast<std::size_t>(degree_v + 1)),
        points_(uninitialised<Vec3>(count * size_)),
        weights_(rational ? uninitialised<double>(count * size_) : nullptr) {}

  bool rational() const { return weights_ != nullptr; }
  Vec3* points(std::size_t patch) { return &points_[patch * size_]; }
  double* weights(std::size_t patch) { return &weights_[patch * size_]; }

  /// All of them, in order.
  std::vector<BezierPatch> take() {
    std::vector<BezierPatch> patches;
    patches.reserve(count_);
    for (std::size_t k = 0; k < count_; ++k) {
      BezierPatch patch;
      patch.degree_u_ = degree_u_;
      patch.degree_v_ = degree_v_;
      patch.points_ = std::shared_ptr<const Vec3[]>(points_, points(k));
      if (weights_) patch.weights_ = std::shared_ptr<const double[]>(weights_, weights(k));
      assert(is_finite(patch.points_[0]) && is_finite(patch.points_[size_ - 1]));
      patches.push_back(std::move(patch));
    }
    return patches;
  }

 private:
  /// make_shared would write zeros first.
  template <class T>
  static std::shared_ptr<T[]> uninitialised(std::size_t count) {
    std::allocator<T> allocator;
    return {allocator.allocate(count), [allocator, count](T* memory) mutable { allocator.deallocate(memory, count); }};
  }

  int degree_u_, degree_v_;
  std::size_t count_, size_;
  std::shared_ptr<Vec3[]> points_;
  std::shared_ptr<double[]> weights_;
};

}  // namespace tessera
