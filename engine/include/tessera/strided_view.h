#pragma once
// Sized, strided views of the caller's memory. They own nothing and never allocate.

#include <array>
#include <cstddef>
#include <span>

#pragma GCC visibility push(default)
namespace tessera::inline abi_0_1 {

/// `size` records of N components each: component c of record k is `component[c][k * stride]`.
/// It names both structure-of-arrays and interleaved memory. An empty view (the default) means "not wanted".
template <class T, int N>
struct VectorView {
  std::array<T*, N> component{};  ///< the first value of each component
  std::ptrdiff_t stride = 1;      ///< in elements of T, at least 1
  std::size_t size = 0;           ///< how many records fit

  bool empty() const { return component[0] == nullptr; }  ///< not wanted
  /// Component c of record k < size.
  T& at(std::size_t k, int c) const {
    return component[static_cast<std::size_t>(c)][static_cast<std::ptrdiff_t>(k) * stride];
  }

  /// One array a component. The shortest array bounds the size.
  static VectorView soa(const std::array<std::span<T>, N>& arrays) {
    VectorView view;
    view.size = arrays[0].size();
    for (std::size_t c = 0; c < N; ++c) {
      view.component[c] = arrays[c].data();
      if (arrays[c].size() < view.size) view.size = arrays[c].size();
    }
    return view;
  }
  /// Records of `record` elements; this vector's components are `first`, `first + 1`, ... of each.
  /// Example: positions and normals in one buffer of 6 floats a vertex: interleaved(buffer, 6, 0) and (buffer, 6, 3).
  /// Of memory that does not hold one record, or of records of no elements: of size 0, from the memory's begin.
  static VectorView interleaved(std::span<T> memory, std::size_t record = N, std::size_t first = 0) {
    VectorView view;
    view.stride = static_cast<std::ptrdiff_t>(record);
    const bool holds_one = record > 0 && memory.size() >= N && first <= memory.size() - N;
    if (holds_one) view.size = (memory.size() - first - N) / record + 1;
    for (std::size_t c = 0; c < N; ++c) view.component[c] = memory.data() + (holds_one ? first + c : 0);
    return view;
  }
};

template <class T>
using View1 = VectorView<T, 1>;
template <class T>
using View3 = VectorView<T, 3>;
template <class T>
using View2 = VectorView<T, 2>;

}  // namespace tessera::inline abi_0_1
#pragma GCC visibility pop
