#pragma once
// Bezier patches that share arrays of points, of whatever degrees they are: a few allocations instead of two a patch.

#include <algorithm>
#include <memory>
#include <span>

#include "tessera/bezier_patch.h"

namespace tessera {

/// Where the patches of a file keep their points. An array lives as long as a patch that has points in it.
class PatchPool {
 public:
  /// The same patch, its numbers in the pool.
  BezierPatch placed(const BezierPatch& patch) {
    BezierPatch copy = patch;
    copy.points_ = points_.copy_of(patch.points());
    if (patch.is_rational()) copy.weights_ = weights_.copy_of(patch.weights());
    return copy;
  }

 private:
  template <class T>
  class Arrays {
   public:
    std::shared_ptr<const T[]> copy_of(std::span<const T> values) {
      if (values.size() > size_ - used_) {
        size_ = std::max(values.size(), std::clamp<std::size_t>(2 * size_, 16, largest));
        used_ = 0;
        array_ = std::shared_ptr<T[]>(new T[size_]);
      }
      T* const place = &array_[used_];
      std::copy(values.begin(), values.end(), place);
      used_ += values.size();
      return {array_, place};
    }

   private:
    static constexpr std::size_t largest =
        2048;  // what may be left over at the end is small beside a file that fills it
    std::shared_ptr<T[]> array_;
    std::size_t size_ = 0, used_ = 0;
  };

  Arrays<Vec3> points_;
  Arrays<double> weights_;
};

}  // namespace tessera
