#pragma once
// Work before the evaluation of scattered samples, in loops over samples that the compiler turns into vectors: checks
// whether they can be evaluated, and cuts them into slots.
//
// Needs before it, outside of the instruction set's namespace: kernel/isa/lanes.h, kernel/point/point_kernels.h.

template <class T>
inline bool all_within(const T* values, std::size_t count, T low, T high) {
  unsigned outside = 0;
  for (std::size_t k = 0; k < count; ++k) outside |= !((values[k] >= low) & (values[k] <= high));
  return outside == 0;
}

template <class T>
bool check_points(const PointCheckJob<T>& job) {
  unsigned outside = 0;
  for (std::size_t k = 0; k < job.count; ++k) outside |= job.patch[k] >= job.patches;
  return outside == 0 && all_within(job.u, job.count, job.low, job.high) &&
         all_within(job.v, job.count, job.low, job.high);
}

/// Shorter runs of one patch in a vector are faster among their neighbours' samples.
template <class L>
inline constexpr int shortest_run = (7 * L::width + 9) / 10;

/// Returns how many of the next `rest` samples, at most block_lanes, lie on the patch of the first and are best taken
/// alone.
template <class L>
inline int run_length(const std::uint32_t* patch, int rest) {
  if (patch[shortest_run<L> - 1] != patch[0] || rest < shortest_run<L>) return 0;
  std::uint32_t differing = 0;
  for (int lane = 1; lane < block_lanes; ++lane) differing |= patch[lane] ^ patch[0];
  if (differing == 0 && rest >= block_lanes) return block_lanes;
  int length = 1;
  while (length < rest && patch[length] == patch[0]) ++length;
  const int last = length % L::width;  // samples of the last vector
  return last < shortest_run<L> ? length - last : length;
}

/// Cuts the next samples into slots: of one patch where runs are long enough, of any samples otherwise.
template <class L>
inline void cut_slots(PointJob<typename L::Scalar>& job) {
  job.slot_count = 0;
  while (job.slot_count < point_slots && job.next < job.count) {
    const int rest = job.count - job.next, run = run_length<L>(job.patch + job.next, rest);
    const int taken = run > 0 ? run : rest < block_lanes ? rest : block_lanes;
    job.slots[job.slot_count++] = {job.next, taken, run > 0};
    job.next += taken;
  }
}
