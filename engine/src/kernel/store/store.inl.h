#pragma once
// Stores of vectors and of records of three and six components.
//
// Needs before it, outside of the instruction set's namespace: kernel/isa/block_lanes.h, kernel/isa/lanes.h.

template <class L, bool Streaming>
[[gnu::always_inline]] inline void store(typename L::Scalar* memory, const typename L::Batch& vector) {
  if constexpr (Streaming) {
    L::stream(memory, vector);
  } else {
    L::store(memory, vector);
  }
}
template <class L, bool Streaming>
[[gnu::always_inline]] inline void store(typename L::Scalar* memory, const typename L::Batch (&vector)[3]) {
  for (int c = 0; c < 3; ++c) store<L, Streaming>(memory + c * block_lanes, vector[c]);
}

/// Writes six values of each lane, three of `a` and three of `b`, to out[lane] + at.
template <class L>
[[gnu::always_inline]] inline void store_sixes(const typename L::Batch (&a)[3], const typename L::Batch (&b)[3],
                                               float* const* out, std::ptrdiff_t at) {
  if constexpr (L::width == 4) {
    typename L::Batch first[4] = {a[0], a[1], a[2], b[0]}, rest[4] = {b[1], b[2], b[1], b[2]};
    L::transpose(first);
    L::transpose(rest);
    for (int l = 0; l < 4; ++l) {
      first[l].store_unaligned(out[l] + at);
      __builtin_memcpy(out[l] + at + 4, &rest[l], 2 * sizeof(float));
    }
  } else {
    put_sixes(a, b, out, at);  // of longer vectors: beside their Lanes
  }
}

/// The layout of records in memory.
enum class Records { packed, arrays, strided };

/// Stores the first `count` lanes of three components to the job's `out` and `stride`, from a record on.
template <class L, Records Layout, class Job>
[[gnu::always_inline]] inline void store_records(const Job& job, std::ptrdiff_t record, typename L::Batch (&p)[3],
                                                 int count) {
  using T = typename L::Scalar;
  if constexpr (Layout == Records::arrays) {
    for (int c = 0; c < 3; ++c) L::store_first(job.out[c] + record, p[c], count);
  } else if constexpr (Layout == Records::packed) {
    L::interleave(p);
    T* out = job.out[0] + 3 * record;
    if (count == L::width) {
      for (int k = 0; k < 3; ++k) L::store_first(out + k * L::width, p[k], L::width);
      return;
    }
    for (int k = 0; k * L::width < 3 * count; ++k) {
      const int rest = 3 * count - k * L::width;
      L::store_first(out + k * L::width, p[k], rest < L::width ? rest : int{L::width});
    }
  } else {
    alignas(64) T values[L::width];
    for (int c = 0; c < 3; ++c) {
      L::store(values, p[c]);
      for (int l = 0; l < count; ++l) job.out[c][(record + l) * job.stride] = values[l];
    }
  }
}
