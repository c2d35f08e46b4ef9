#pragma once
// FNV-1a over the bytes of numbers, to compare the results of two programs by a word. Zeros of either sign and all
// kinds of NaN hash by their own bits, because the same bytes are required.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <type_traits>
#include <vector>

#include <tessera/bezier_patch.h>
#include <tessera/geometry.h>
#include <tessera/status.h>

class Hash {
 public:
  void bytes(const void* memory, std::size_t count) {
    const auto* byte = static_cast<const unsigned char*>(memory);
    for (std::size_t k = 0; k < count; ++k) value_ = (value_ ^ byte[k]) * 0x100000001b3u;
  }
  template <class T>
  requires(std::is_arithmetic_v<T> || std::is_enum_v<T>) void add(T number) { bytes(&number, sizeof number); }
  void add(const tessera::Vec3& p) {
    for (const double x : {p.x, p.y, p.z}) add(x);
  }
  void add(const tessera::SurfaceJet& jet) {
    for (const tessera::Vec3& p : {jet.position, jet.du, jet.dv, jet.duu, jet.duv, jet.dvv}) add(p);
  }
  template <class T>
  void add(const std::vector<T>& numbers) {
    for (const T& number : numbers) add(number);
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325u;
};

/// Numbers of one seed, the same by every compiler (splitmix64).
class Seeded {
 public:
  explicit Seeded(std::uint64_t seed) : state_(seed) {}
  std::uint64_t word() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  /// Uniform in [0, 1).
  double unit() { return static_cast<double>(word() >> 11) * 0x1p-53; }
  double between(double low, double high) { return low + (high - low) * unit(); }

 private:
  std::uint64_t state_;
};

inline void require(const tessera::Status& status) {
  if (status.ok()) return;
  std::fprintf(stderr, "same_bytes: %s\n", status.message().c_str());
  std::exit(1);
}

template <class T>
T value_of(tessera::Result<T> result) {
  if (!result) require(result.status());
  return *std::move(result);
}
