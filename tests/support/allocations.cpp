#include "support/allocations.h"

#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::size_t> count{0}, bytes_in_all{0}, held{0}, peak{0};

void* counted(std::size_t bytes, std::size_t alignment) {
  ++count;
  bytes_in_all += bytes;
  void* memory = std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
  if (memory == nullptr) throw std::bad_alloc();
  const std::size_t now = held += ::malloc_usable_size(memory);
  for (std::size_t before = peak; before < now && !peak.compare_exchange_weak(before, now);) {
  }
  return memory;
}

void release(void* memory) {
  held -= ::malloc_usable_size(memory);  // 0 for a null pointer
  std::free(memory);
}

}  // namespace

namespace tessera::test {

std::size_t allocation_count() { return count; }
std::size_t allocated_bytes() { return bytes_in_all; }
std::size_t peak_bytes() { return peak; }
std::size_t restart_peak() { return peak = held.load(); }

}  // namespace tessera::test

void* operator new(std::size_t bytes) { return counted(bytes, alignof(std::max_align_t)); }
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {  // std::stable_sort asks for its buffer so
  try {
    return counted(bytes, alignof(std::max_align_t));
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
void* operator new(std::size_t bytes, std::align_val_t alignment) { return counted(bytes, static_cast<std::size_t>(alignment)); }
void operator delete(void* memory) noexcept { release(memory); }
void operator delete(void* memory, std::size_t) noexcept { release(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { release(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { release(memory); }
