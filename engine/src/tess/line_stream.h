#pragma once
// Output that goes past the caches in whole lines, though it is made in pieces of any length.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "base/aligned.h"
#include "kernel/kernel_table.h"

namespace tessera {

/// Takes one piece after the other that lie one behind the other in memory. What a piece completes waits in a queue while the
/// next is made, for its kernel to send. Lives on a task's stack. The first and the last line may be shared with others,
/// and are stored plainly. T has the size of a float.
template <class T>
class LineStream {
  static_assert(sizeof(T) == sizeof(float));
  static constexpr std::size_t line = cache_line / sizeof(T), capacity = 512 * line;

 public:
  /// So many values may be written beyond a piece.
  static constexpr std::size_t slack = 8 * line;

  LineStream(const kernel::KernelTable& kernels, kernel::LineQueue& queue) : kernels_(kernels), queue_(queue) {}
  LineStream(const LineStream&) = delete;
  LineStream& operator=(const LineStream&) = delete;

  /// Begins at `out`.
  void start(T* out) {
    begin_ = filled_ = reinterpret_cast<std::uintptr_t>(out) / sizeof(T) % line;
    out_ = out - begin_;
  }
  /// Memory for the next piece; or null where that is too long: then it is to be written to where it belongs, out(), at
  /// once.
  T* next(std::size_t count) {
    if (filled_ + count <= capacity) return memory_[active_].data() + filled_;
    finish();
    return nullptr;
  }
  T* out() { return out_ + filled_; }

  /// The piece is written. Sends what the queue still holds.
  void commit(std::size_t count) {
    send();
    filled_ += count;
    if (filled_ < 2 * line) return;
    T* const memory = memory_[active_].data();
    if (begin_ > 0) std::copy(memory + begin_, memory + line, out_ + begin_);
    const std::size_t first = begin_ > 0 ? line : 0, whole = filled_ / line * line;
    queue_ = {reinterpret_cast<const float*>(memory + first), reinterpret_cast<float*>(out_ + first),
              (whole - first) / line};
    active_ = 1 - active_;
    std::memcpy(memory_[active_].data(), memory + whole, cache_line);
    out_ += whole;
    filled_ -= whole;
    begin_ = 0;
  }
  /// A piece was written to out().
  void skip(std::size_t count) { start(out() + count); }
  /// All that is left.
  void finish() {
    send();
    std::copy(memory_[active_].data() + begin_, memory_[active_].data() + filled_, out_ + begin_);
    start(out());
  }

 private:
  void send() {
    kernels_.stream_lines(queue_.from, queue_.to, queue_.lines);
    queue_.lines = 0;
  }

  const kernel::KernelTable& kernels_;
  kernel::LineQueue& queue_;
  T* out_ = nullptr;                    ///< where the active memory belongs, the start of a line
  std::size_t begin_ = 0, filled_ = 0;  ///< of the active memory
  std::size_t active_ = 0;
  alignas(cache_line) std::array<std::array<T, capacity + slack>, 2> memory_;
};

}  // namespace tessera
