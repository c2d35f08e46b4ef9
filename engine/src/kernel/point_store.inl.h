// Outputs of scattered samples from the stage to the caller's records. Included by isa_*.cpp as sample_kernel.inl.h is.

/// The first `count` samples of vectors of three, or of numbers, from neighbouring records on.
template <class L, Records Layout>
inline void store_slot(const PointStoreJob<typename L::Scalar>& job, const typename L::Scalar* stage,
                       std::ptrdiff_t record, int count) {
  for (int lane = 0; lane < count; lane += L::width) {
    const int part = count - lane < L::width ? count - lane : int{L::width};
    if (job.width == 1 && job.stride == 1) {
      L::store_first(job.out[0] + record + lane, L::load(stage + lane), part);
    } else {
      typename L::Batch p[3];
      for (int c = 0; c < 3; ++c) p[c] = L::load(stage + c * block_lanes + lane);
      store_records<L, Layout>(job, record + lane, p, part);
    }
  }
}

/// One component after the other, each sample where it belongs.
template <class T>
inline void store_apart(const PointStoreJob<T>& job, const T* stage, const PointSlot& slot) {
  for (int c = 0; c < job.width; ++c)
    for (int lane = 0; lane < slot.count; ++lane) {
      const std::ptrdiff_t sample = slot.first + lane;
      const std::ptrdiff_t record = job.records ? static_cast<std::ptrdiff_t>(job.records[sample]) : sample;
      job.out[c][record * job.stride] = stage[c * block_lanes + lane];
    }
}

template <class L>
void store_points(const PointStoreJob<typename L::Scalar>& job) {
  const bool together = !job.records, number = job.width == 1;
  const bool arrays = together && job.stride == 1;
  const bool packed =
      together && !number && job.stride == 3 && job.out[1] == job.out[0] + 1 && job.out[2] == job.out[0] + 2;
  for (int k = 0; k < job.slot_count; ++k) {
    const auto* stage = job.stage + std::ptrdiff_t{k} * job.width * block_lanes;
    const PointSlot slot = job.slots[k];
    if (packed) {
      store_slot<L, Records::packed>(job, stage, slot.first, slot.count);
    } else if (arrays) {
      store_slot<L, Records::arrays>(job, stage, slot.first, slot.count);
    } else {
      store_apart(job, stage, slot);
    }
  }
}
