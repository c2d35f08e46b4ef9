#pragma once
// Span search for a batch of parameters, lanes = parameters: binary search in the same number of steps for each,
// without a branch that depends on them, in loops that the compiler turns into gathers and comparisons.
//
// Needs before it, outside of the instruction set's namespace: kernel/isa/lanes.h, kernel/point/point_kernels.h.

inline void locate_batch(const LocateJob& job, std::size_t first) {
  constexpr std::size_t lanes = locate_lanes;
  const double* const t = job.t + first;
  alignas(64) std::int64_t base[lanes] = {};
  for (auto rest = static_cast<std::int64_t>(job.spans); rest > 1;) {
    const std::int64_t half = rest / 2;
    for (std::size_t l = 0; l < lanes; ++l) base[l] = job.breaks[base[l] + half] <= t[l] ? base[l] + half : base[l];
    rest -= half;
  }
  for (std::size_t l = 0; l < lanes; ++l) {
    const double start = job.breaks[base[l]], end = job.breaks[base[l] + 1], width = end - start;
    const double local = (t[l] - start) / width;
    job.span[first + l] = base[l];
    job.width[first + l] = width;
    job.local[first + l] = t[l] == end ? 1 : local;
  }
}

inline void locate(const LocateJob& job) {
  for (std::size_t first = 0; first < job.count; first += locate_lanes) locate_batch(job, first);
}
