#pragma once
// Stores numbers that follow each other in memory, lanes = neighbouring numbers, by whole aligned vectors.
//
// Needs before it, outside of the instruction set's namespace: kernel/isa/lanes.h, kernel/store/stream_state.h.

#include "kernel/store/store.inl.h"

/// True if there is a LineSink of such vectors.
template <class L>
constexpr bool has_lines = requires {
  L::store_between;
};

/// Joins runs of numbers of any length that follow each other in memory.
template <class L, bool Streaming>
class LineSink {
 public:
  explicit LineSink(float* memory) : shift_(L::shift_by(0)), carry_(L::broadcast(0)) { start(memory); }
  /// Continues where another stopped.
  explicit LineSink(const StreamState& state) : LineSink(state.next) {
    begin_ = state.first > next_ ? static_cast<int>(state.first - next_) : 0;
    carry_ = L::load(state.carry);
  }
  void stop(StreamState& state) const {
    state.first = next_ + begin_;
    state.next = next_ + end_;
    L::store(state.carry, carry_);
  }

  /// Sets the place of the next number.
  [[gnu::always_inline]] void turn_to(float* memory) {
    if (memory == next_ + end_) return;
    finish();
    start(memory);
  }
  [[gnu::always_inline]] void put(const typename L::Batch& vector) { send(L::shift_in(carry_, vector, shift_)); }
  /// Puts the first `count` numbers of a vector.
  [[gnu::always_inline]] void put(const typename L::Batch& vector, int count) {
    auto joined = L::shift_in(carry_, vector, shift_);
    end_ += count;
    if (end_ >= L::width) {
      send(joined);
      joined = L::shift_in(carry_, vector, shift_);
      end_ -= L::width;
    }
    shift_ = L::shift_by(end_);
    carry_ = L::carried(joined, shift_);
  }
  [[gnu::always_inline]] void finish() {
    L::store_between(next_, L::shift_in(carry_, carry_, shift_), begin_, end_);
    begin_ = 0;
  }

 private:
  [[gnu::always_inline]] void start(float* memory) {
    begin_ = end_ = static_cast<int>(reinterpret_cast<std::uintptr_t>(memory) / sizeof(float) % L::width);
    next_ = memory - begin_;
    shift_ = L::shift_by(end_);
  }
  [[gnu::always_inline]] void send(const typename L::Batch& vector) {
    if (begin_ > 0) {
      L::store_between(next_, vector, begin_, L::width);
      begin_ = 0;
    } else {
      store<L, Streaming>(next_, vector);
    }
    next_ += L::width;
  }

  float* next_;  ///< the current vector, of which the numbers begin_ .. end_ - 1 are known
  int begin_, end_;
  typename L::Shift shift_;  ///< by end_
  typename L::Batch carry_;  ///< its last end_ lanes are those numbers
};
