#pragma once
// Sized, strided views of the caller's memory. A view owns nothing and never allocates.

#include <array>
#include <cstddef>
#include <span>

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// A view of `size` records of N components each, for structure-of-arrays and interleaved memory. Component c of record
/// k is `component[c][k * stride]`. An empty view (the default) means "not wanted".
template <class T, int N>
struct VectorView {
  std::array<T*, std::size_t{N}> component{};  ///< the first value of each component
  std::ptrdiff_t stride = 1;                   ///< in elements of T, at least 1
  std::size_t size = 0;                        ///< number of records that fit

  bool empty() const { return component[0] == nullptr; }  ///< whether the output is not wanted
  /// Returns component c of record k < size.
  T& at(std::size_t k, int c) const {
    return component[static_cast<std::size_t>(c)][static_cast<std::ptrdiff_t>(k) * stride];
  }

  /// Makes a view of a member of each record of an array, for example View3<float>::of(vertices, &Vertex::position).
  /// The member is N values of type T in a row: an array or a struct of them.
  template <class Records, class Record, class Member>
  static VectorView of(Records&& records, Member Record::*member) {
    static_assert(sizeof(Member) == std::size_t{N} * sizeof(T), "the member is N values of type T");
    static_assert(sizeof(Record) % sizeof(T) == 0, "records are whole numbers of T apart");
    VectorView view;
    view.size = std::size(records);
    view.stride = static_cast<std::ptrdiff_t>(sizeof(Record) / sizeof(T));
    if (view.size == 0) return view;
    T* const first = reinterpret_cast<T*>(&(std::data(records)->*member));
    for (std::size_t c = 0; c < std::size_t{N}; ++c) view.component[c] = first + c;
    return view;
  }

  /// Makes a view of one array per component. The shortest array limits the size.
  static VectorView soa(const std::array<std::span<T>, std::size_t{N}>& arrays) {
    VectorView view;
    view.size = arrays[0].size();
    for (std::size_t c = 0; c < N; ++c) {
      view.component[c] = arrays[c].data();
      if (arrays[c].size() < view.size) view.size = arrays[c].size();
    }
    return view;
  }
  /// Makes a view of records of `record` elements each, in which this vector's components are the N elements from
  /// `first` on. Example, positions and normals in one buffer of 6 floats per vertex: interleaved(buffer, 6, 0) and
  /// (buffer, 6, 3).
  ///
  /// If the memory holds no whole vector, or `record` is 0, the view has size 0 and points to the start of the memory.
  static VectorView interleaved(std::span<T> memory, std::size_t record = N, std::size_t first = 0) {
    VectorView view;
    view.stride = static_cast<std::ptrdiff_t>(record);
    const bool holds_one = record > 0 && memory.size() >= N && first <= memory.size() - N;
    if (holds_one) view.size = (memory.size() - first - N) / record + 1;
    for (std::size_t c = 0; c < N; ++c) view.component[c] = memory.data() + (holds_one ? first + c : 0);
    return view;
  }
};

/// View of scalars.
template <class T>
using View1 = VectorView<T, 1>;
/// View of vectors in space.
template <class T>
using View3 = VectorView<T, 3>;
/// View of pairs, such as parameters.
template <class T>
using View2 = VectorView<T, 2>;

/// One member per quantity. `Vector` is the type of those with three components, `Scalar` of those with one, the others
/// of the two kinds. r is the point, N the unit normal; derivatives are by the parameters of the call.
template <class Vector, class Scalar = Vector, class NormalKinds = Scalar, class CurvatureKinds = NormalKinds>
struct Quantities {
  Vector position = {}, du = {}, dv = {}, normal = {};  ///< r, r_u, r_v, N
  Vector duu = {}, duv = {}, dvv = {};                  ///< r_uu, r_uv, r_vv
  Vector first_form = {};                               ///< E, F, G: r_u.r_u, r_u.r_v, r_v.r_v
  Vector second_form = {};                              ///< L, M, N: r_uu.N, r_uv.N, r_vv.N
  Scalar gaussian = {}, mean = {};                      ///< K = k1 k2, H = (k1 + k2) / 2
  Scalar first_curvature = {}, second_curvature = {};   ///< k1 >= k2
  Vector first_direction = {}, second_direction = {};   ///< unit tangents of k1 and k2, first x second = N
  NormalKinds normal_kind = {};                         ///< regular, a limit, or undefined
  CurvatureKinds curvature_kind = {};                   ///< distinct, umbilic, or undefined
};

/// A set of quantities, as `{.position = true, .normal = true}`.
using QuantityFlags = Quantities<bool>;

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
