#pragma once
// Checks the views of a call: each must be complete, long enough and aligned, and an output must share no memory.

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "base/internal_export.h"
#include "tessera/status.h"
#include "tessera/strided_view.h"

namespace tessera { inline namespace abi_0_1 {

/// Collects the views of one call, and keeps the first error.
class ViewChecks {
 public:
  /// `records`: how many records of a view are used, unless add() states another number.
  explicit ViewChecks(std::size_t records) : records_(records) {}

  /// Errors: invalid_argument (a component is missing or misaligned, the stride is below 1 or leaves memory),
  /// buffer_too_small. `name` must outlive this.
  template <class T, int N>
  void add(const char* name, const VectorView<T, N>& view) {
    add(name, view, records_);
  }
  template <class T, int N>
  void add(const char* name, const VectorView<T, N>& view, std::size_t records) {
    for (T* component : view.component)
      add({name, reinterpret_cast<std::uintptr_t>(component), records, view.stride, sizeof(T), !std::is_const_v<T>},
          view.size, alignof(T));
  }

  /// Returns the first error of all views; or invalid_argument if an output shares memory with another view.
  TESSERA_INTERNAL_EXPORT Status status() const;

 private:
  /// One component of a view.
  struct Array {
    const char* name;
    std::uintptr_t begin;
    std::size_t records;
    std::ptrdiff_t stride;  ///< in elements
    std::size_t element;    ///< bytes
    bool written;
  };
  static constexpr std::size_t max_arrays = 64;

  TESSERA_INTERNAL_EXPORT void add(const Array& array, std::size_t size, std::size_t alignment);
  bool collide(const Array& a, const Array& b) const;

  std::size_t records_;
  Status error_;
  std::array<Array, max_arrays> arrays_{};
  std::size_t count_ = 0;
};

}}  // namespace tessera::abi_0_1
