#pragma once
// Readers of a call's rays and writers of its hits, whatever their layout, in turns of up to 16.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "ray/scene/batch_filter.h"
#include "tessera/ray_scene.h"

namespace tessera { inline namespace abi_0_1 {

inline constexpr std::size_t rays_per_turn = 16;

/// Memory for the records of a turn, without initialisation.
template <class T>
class TurnRoom {
 public:
  std::span<T> span() { return {reinterpret_cast<T*>(bytes_), rays_per_turn}; }

 private:
  alignas(T) std::byte bytes_[rays_per_turn * sizeof(T)];
};

class RayReader {
 public:
  /// Returns the rays from `first` on: the caller's own, or made in `room`. count <= rays_per_turn.
  virtual std::span<const Ray> read(std::size_t first, std::size_t count, std::span<Ray> room) const = 0;
  virtual std::uint32_t mask(std::size_t) const { return ~0u; }

 protected:
  ~RayReader() = default;
};

/// The wanted parts of a hit besides indices, parameters and t.
struct HitParts {
  bool point = true;        ///< position and residual
  bool derivatives = true;  ///< du and dv
  bool normal = true;       ///< and the flags that depend on it
  bool any() const { return point || derivatives || normal; }
};

class HitWriter {
 public:
  virtual HitParts parts() const { return {}; }
  /// Returns the place for the hits of a turn: the caller's own memory or `room`.
  virtual std::span<Hit> place(std::size_t first, std::size_t count, std::span<Hit> room) const = 0;
  /// Called with the hits of a turn once they are in that place.
  virtual void write(std::size_t first, std::span<const Hit> hits) const = 0;

 protected:
  ~HitWriter() = default;
};

class RaySpan final : public RayReader {
 public:
  explicit RaySpan(std::span<const Ray> rays) : rays_(rays) {}
  std::span<const Ray> read(std::size_t first, std::size_t count, std::span<Ray>) const override {
    return rays_.subspan(first, count);
  }

 private:
  std::span<const Ray> rays_;
};

class HitSpan final : public HitWriter {
 public:
  explicit HitSpan(std::span<Hit> hits) : hits_(hits) {}
  std::span<Hit> place(std::size_t first, std::size_t count, std::span<Hit>) const override {
    return hits_.subspan(first, count);
  }
  void write(std::size_t, std::span<const Hit>) const override {}

 private:
  std::span<Hit> hits_;
};

/// The rays of a call, and the caller's filter of their hits.
struct RayBatch {
  const RayReader& rays;
  BatchFilter* filter = nullptr;  ///< null: all hits count

  bool stopped() const { return filter != nullptr && filter->stopped(); }
};

/// Calls body(first, count) for the rays of a task turn by turn, until a filter stops the batch.
template <class Body>
void for_turns(const RayBatch& batch, std::size_t begin, std::size_t end, const Body& body) {
  for (std::size_t first = begin; first < end && !batch.stopped(); first += rays_per_turn)
    body(first, std::min(rays_per_turn, end - first));
}

}}  // namespace tessera::abi_0_1
