#include "support/allocations.h"

#include <link.h>
#include <malloc.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <new>

namespace {

std::atomic<std::size_t> count{0}, bytes_in_all{0}, held{0}, peak{0};

/// The number of calls before one fails; negative if none does.
std::atomic<long> left{-1};
std::atomic<bool> failed{false};

/// The code of Embree or oneTBB.
struct Range {
  std::uintptr_t begin, end;
};
std::array<Range, 16> foreign{};
std::size_t foreign_count = 0;

int note_foreign(dl_phdr_info* info, std::size_t, void*) {
  const auto is = [&](const char* library) { return std::strstr(info->dlpi_name, library) != nullptr; };
  if (!is("libembree") && !is("libtbb")) return 0;
  for (int k = 0; k < info->dlpi_phnum; ++k) {
    const auto& part = info->dlpi_phdr[k];
    if (part.p_type != PT_LOAD || !(part.p_flags & PF_X) || foreign_count == foreign.size()) continue;
    const std::uintptr_t begin = info->dlpi_addr + part.p_vaddr;
    foreign[foreign_count++] = {begin, begin + part.p_memsz};
  }
  return 0;
}

bool is_foreign(const void* caller) {
  const auto place = reinterpret_cast<std::uintptr_t>(caller);
  for (std::size_t k = 0; k < foreign_count; ++k)
    if (place >= foreign[k].begin && place < foreign[k].end) return true;
  return false;
}

/// Whether this call is the one that fails.
bool fails(const void* caller) {
  if (left.load(std::memory_order_relaxed) < 0 || is_foreign(caller) || left.fetch_sub(1) != 0) return false;
  failed = true;
  return true;
}

void* counted(std::size_t bytes, std::size_t alignment, const void* caller) {
  ++count;
  if (fails(caller)) throw std::bad_alloc();
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

void fail_allocation(std::size_t n) {
  if (foreign_count == 0) ::dl_iterate_phdr(note_foreign, nullptr);
  failed = false;
  left = static_cast<long>(n);
}
bool stop_failing() {
  left = -1;
  return failed;
}

}  // namespace tessera::test

void* operator new(std::size_t bytes) { return counted(bytes, alignof(std::max_align_t), __builtin_return_address(0)); }
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {  // std::stable_sort's buffer
  try {
    return counted(bytes, alignof(std::max_align_t), __builtin_return_address(0));
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return counted(bytes, static_cast<std::size_t>(alignment), __builtin_return_address(0));
}
void operator delete(void* memory) noexcept { release(memory); }
void operator delete(void* memory, std::size_t) noexcept { release(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { release(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { release(memory); }
