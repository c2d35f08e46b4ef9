#pragma once
// Two sources of scattered samples: by patch, or by surface. A source first checks its samples, then copies them chunk
// by chunk.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <type_traits>

#include "base/text.h"
#include "eval/grid_checks.h"
#include "eval/point_chunk.h"
#include "eval/surface_map_impl.h"

namespace tessera { inline namespace abi_0_1 {

/// Returns the status of a sample that cannot be evaluated.
inline Status sample_error(StatusCode code, std::size_t sample, const std::string& why) {
  return Status(code, "sample " + std::to_string(sample) + ": " + why, static_cast<std::ptrdiff_t>(sample));
}
inline Status parameter_error(const char* direction, std::size_t sample, double t, double from, double to) {
  const std::string what = std::string(direction) + " = " + text(t);
  if (!std::isfinite(t)) return sample_error(StatusCode::non_finite, sample, what + " is not finite");
  return sample_error(StatusCode::invalid_argument, sample,
                      what + " is outside [" + text(from) + ", " + text(to) + "]");
}

/// Copies values [begin, begin + count) of a view.
template <class From, class To>
void gather(const View1<const From>& view, std::size_t begin, std::size_t count, To* to) {
  const From* from = view.component[0] + static_cast<std::ptrdiff_t>(begin) * view.stride;
  if (std::is_same_v<From, To> && view.stride == 1) {
    std::memcpy(to, from, count * sizeof(From));
  } else {
    for (std::size_t k = 0; k < count; ++k) to[k] = from[static_cast<std::ptrdiff_t>(k) * view.stride];
  }
}

/// Samples by patch.
template <class T>
class SamplesByPatch {
 public:
  SamplesByPatch(const PatchSet::Impl& set, const PatchSamples<T>& samples, OutsideDomain outside)
      : patches_(static_cast<std::uint32_t>(set.patches.size())),
        samples_(samples),
        outside_(outside),
        low_(outside == OutsideDomain::error ? T(0) : std::numeric_limits<T>::lowest()),
        high_(outside == OutsideDomain::error ? T(1) : std::numeric_limits<T>::max()) {}

  std::size_t count() const { return samples_.patch.size; }
  bool lengths_fit() const { return samples_.u.size >= count() && samples_.v.size >= count(); }
  void check_views(ViewChecks& checks) const {
    checks.add("patch", samples_.patch);
    checks.add("u", samples_.u);
    checks.add("v", samples_.v);
  }

  /// Returns the error of the first sample in [begin, end) that cannot be evaluated.
  Status check(std::size_t begin, std::size_t end, const kernel::KernelTable& kernels) const {
    if (is_contiguous() && all_pass(begin, end - begin, kernels)) return {};
    for (std::size_t k = begin; k < end; ++k) {
      if (samples_.patch.at(k, 0) >= patches_)
        return sample_error(StatusCode::invalid_argument, k,
                            "there is no patch " + std::to_string(samples_.patch.at(k, 0)) + " in a set of " +
                                std::to_string(patches_));
      for (const auto& [name, t] : {std::pair{"u", samples_.u.at(k, 0)}, {"v", samples_.v.at(k, 0)}})
        if (!(t >= low_ && t <= high_)) return parameter_error(name, k, t, 0, 1);
    }
    return {};
  }

  void fill(std::size_t begin, std::size_t count, const kernel::KernelTable&, ChunkSamples<T>& chunk) const {
    const std::size_t end = begin + count;
    if (outside_ != OutsideDomain::clamp && is_contiguous() && end + ChunkSamples<T>::padding <= this->count()) {
      chunk.patch = samples_.patch.component[0] + begin;
      chunk.u = samples_.u.component[0] + begin;
      chunk.v = samples_.v.component[0] + begin;
      return;
    }
    gather(samples_.patch, begin, count, chunk.own_patch.data());
    gather(samples_.u, begin, count, chunk.own_u.data());
    gather(samples_.v, begin, count, chunk.own_v.data());
    if (outside_ == OutsideDomain::clamp)
      for (auto* parameters : {&chunk.own_u, &chunk.own_v})
        for (std::size_t k = 0; k < count; ++k) (*parameters)[k] = std::clamp<T>((*parameters)[k], 0, 1);
    chunk.use_own();
  }

 private:
  bool is_contiguous() const { return samples_.patch.stride == 1 && samples_.u.stride == 1 && samples_.v.stride == 1; }
  bool all_pass(std::size_t begin, std::size_t count, const kernel::KernelTable& kernels) const {
    const kernel::PointCheckJob<T> job{.patch = samples_.patch.component[0] + begin,
                                       .patches = patches_,
                                       .u = samples_.u.component[0] + begin,
                                       .v = samples_.v.component[0] + begin,
                                       .low = low_,
                                       .high = high_,
                                       .count = count};
    if constexpr (sizeof(T) == 4) {
      return kernels.check_points_f32(job);
    } else {
      return kernels.check_points_f64(job);
    }
  }

  std::uint32_t patches_;
  const PatchSamples<T>& samples_;
  OutsideDomain outside_;
  T low_, high_;  ///< the range of parameters that are evaluated; others are an error
};

/// Samples by surface.
template <class T>
class SamplesBySurface {
 public:
  SamplesBySurface(const SurfaceMap::Impl& map, const SurfaceSamples& samples, OutsideDomain outside)
      : map_(map), samples_(samples), outside_(outside) {}

  std::size_t count() const { return samples_.u.size; }
  bool lengths_fit() const {
    return samples_.v.size >= count() && (samples_.surface.empty() || samples_.surface.size >= count());
  }
  void check_views(ViewChecks& checks) const {
    if (!samples_.surface.empty()) checks.add("surface", samples_.surface);
    checks.add("u", samples_.u);
    checks.add("v", samples_.v);
  }

  Status check(std::size_t begin, std::size_t end, const kernel::KernelTable&) const {
    for (std::size_t k = begin; k < end; ++k) {
      const std::uint32_t surface = surface_of(k);
      if (surface >= map_.surfaces.size() || map_.surfaces[surface].breaks_u.empty())
        return sample_error(StatusCode::invalid_argument, k,
                            "there is no surface " + std::to_string(surface) + " in the set");
      const auto& breaks_u = map_.surfaces[surface].breaks_u;
      const auto& breaks_v = map_.surfaces[surface].breaks_v;
      const double u = samples_.u.at(k, 0), v = samples_.v.at(k, 0);
      if (!passes(u, breaks_u)) return parameter_error("u", k, u, breaks_u.front(), breaks_u.back());
      if (!passes(v, breaks_v)) return parameter_error("v", k, v, breaks_v.front(), breaks_v.back());
    }
    return {};
  }

  void fill(std::size_t begin, std::size_t count, const kernel::KernelTable& kernels, ChunkSamples<T>& chunk) const {
    chunk.scaled = true;
    for (std::size_t first = 0; first < count;) {
      std::size_t last = std::min(count, first + piece);
      const std::uint32_t surface = surface_of(begin + first);
      if (!samples_.surface.empty()) last = first + 1 + equal_after(begin + first, begin + last);
      fill_piece(map_.surfaces[surface], begin, first, last - first, kernels, chunk);
      first = last;
    }
    chunk.use_own();
  }

 private:
  static constexpr std::size_t piece = 256;  ///< samples of one surface that are located at once
  struct Located {
    alignas(cache_line) std::array<double, piece> t, local;
    std::array<std::int64_t, piece> span;
  };

  std::uint32_t surface_of(std::size_t k) const { return samples_.surface.empty() ? 0 : samples_.surface.at(k, 0); }
  std::size_t equal_after(std::size_t k, std::size_t end) const {
    std::size_t next = k + 1;
    while (next < end && surface_of(next) == surface_of(k)) ++next;
    return next - k - 1;
  }
  bool passes(double t, const std::vector<double>& breaks) const {
    if (outside_ == OutsideDomain::error) return t >= breaks.front() && t <= breaks.back();
    return std::isfinite(t);
  }

  void fill_piece(const SurfaceMap::Impl::Surface& surface, std::size_t begin, std::size_t first, std::size_t count,
                  const kernel::KernelTable& kernels, ChunkSamples<T>& chunk) const {
    Located u, v;
    locate(surface.breaks_u, samples_.u, begin + first, count, kernels, u, chunk.width_u.data() + first);
    locate(surface.breaks_v, samples_.v, begin + first, count, kernels, v, chunk.width_v.data() + first);
    const std::size_t columns = surface.breaks_v.size() - 1;
    for (std::size_t k = 0; k < count; ++k) {
      chunk.own_patch[first + k] = static_cast<std::uint32_t>(
          surface.first_patch + static_cast<std::size_t>(u.span[k]) * columns + static_cast<std::size_t>(v.span[k]));
      chunk.own_u[first + k] = static_cast<T>(u.local[k]);
      chunk.own_v[first + k] = static_cast<T>(v.local[k]);
    }
  }

  void locate(const std::vector<double>& breaks, const View1<const double>& parameters, std::size_t begin,
              std::size_t count, const kernel::KernelTable& kernels, Located& located, double* widths) const {
    gather(parameters, begin, count, located.t.data());
    if (outside_ == OutsideDomain::clamp)
      for (std::size_t k = 0; k < count; ++k) located.t[k] = std::clamp(located.t[k], breaks.front(), breaks.back());
    const std::size_t lanes = kernel::locate_lanes, whole = (count + lanes - 1) / lanes * lanes;
    std::fill(located.t.begin() + static_cast<std::ptrdiff_t>(count),
              located.t.begin() + static_cast<std::ptrdiff_t>(whole), breaks.front());
    alignas(cache_line) std::array<double, piece> width;
    kernels.locate({.breaks = breaks.data(),
                    .spans = breaks.size() - 1,
                    .t = located.t.data(),
                    .count = count,
                    .span = located.span.data(),
                    .local = located.local.data(),
                    .width = width.data()});
    std::copy_n(width.begin(), count, widths);
  }

  const SurfaceMap::Impl& map_;
  const SurfaceSamples& samples_;
  OutsideDomain outside_;
};

}}  // namespace tessera::abi_0_1
