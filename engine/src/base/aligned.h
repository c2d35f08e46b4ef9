#pragma once
// Memory aligned to cache lines and to the widest vectors.

#include <cstddef>
#include <new>
#include <vector>

#include "base/internal_export.h"

namespace tessera { inline namespace abi_0_1 {

inline constexpr std::size_t cache_line = 64;

/// Size of a large page. Allocations of several such pages ask the system for them: with 4 KiB pages, scattered reads
/// wait longer for the page's address than for the values. For smaller allocations the request costs more time than it
/// saves.
inline constexpr std::size_t large_page = std::size_t{2} << 20, min_bytes_in_large_pages = 8 * large_page;

/// Alignment of an allocation of `bytes`.
constexpr std::align_val_t alignment_of(std::size_t bytes) {
  return std::align_val_t{bytes >= min_bytes_in_large_pages ? large_page : cache_line};
}
/// Allocates `bytes` with alignment_of(bytes). Throws std::bad_alloc.
TESSERA_INTERNAL_EXPORT void* allocate_aligned(std::size_t bytes);

template <class T>
struct AlignedAllocator {
  using value_type = T;
  AlignedAllocator() = default;
  template <class U>
  AlignedAllocator(const AlignedAllocator<U>&) {}
  T* allocate(std::size_t count) {
    if (count > static_cast<std::size_t>(-1) / sizeof(T)) throw std::bad_array_new_length();
    return static_cast<T*>(allocate_aligned(count * sizeof(T)));
  }
  void deallocate(T* memory, std::size_t count) { ::operator delete(memory, alignment_of(count * sizeof(T))); }
  friend bool operator==(const AlignedAllocator&, const AlignedAllocator&) { return true; }
};

template <class T>
using AlignedVector = std::vector<T, AlignedAllocator<T>>;

template <class T>
struct UnsetAllocator : AlignedAllocator<T> {
  UnsetAllocator() = default;
  template <class U>
  UnsetAllocator(const UnsetAllocator<U>&) {}
  template <class U>
  void construct(U* at) {
    ::new (static_cast<void*>(at)) U;
  }
};

/// A vector for numbers that are all written after resize(), which leaves new ones unset.
template <class T>
using UnsetVector = std::vector<T, UnsetAllocator<T>>;

}}  // namespace tessera::abi_0_1
