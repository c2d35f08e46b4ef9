#pragma once
// What the meshes of many patches share: weights, parameters and strips of triangles of all segments that are in use.

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "base/aligned.h"
#include "kernel/mesh_kernels.h"
#include "tess/stitched_patch.h"
#include "tessera/bezier_patch.h"

namespace tessera {

/// Made while a mesh is planned, looked up by number while it is written. Rates are at most 4096.
class MeshTables {
 public:
  /// `with_cubic`: for kernels that take bicubic patches point by point as well.
  explicit MeshTables(bool with_cubic) : with_cubic_(with_cubic) {}

  /// All that a patch of these degrees needs that is divided so.
  void add(int degree_u, int degree_v, const Division& division) {
    if (division.empty) return;
    for (const Side side : all_sides) {
      const int degree = runs_along_u(side) ? degree_u : degree_v;
      const Segments inner = division.inner_along(side), border = division.border[static_cast<std::size_t>(side)];
      if (inner.is_uniform() && border.is_uniform()) {
        add_uniform(degree, inner, border);
      } else {
        add_unseen(degree, division.inner_along_ring(side), division.along_ring(side));
      }
    }
  }

  // Once added. Layouts: see kernel::MeshVertexJob and MeshBorder. Weights are rounded once, to float.
  const float* inner_weights(int degree, Segments along) const {
    return tables(along).inner[at(degree)][place(along)].data();
  }
  const float* border_weights(int degree, Segments along) const {
    return tables(along).border[at(degree)][place(along)].data();
  }
  /// See kernel::MeshVertexJob::points.
  const kernel::MeshCubicInner* cubic_inner(Segments along) const {
    return &tables(along).cubic_inner[place(along)].table;
  }
  const kernel::MeshCubicBorder* cubic_border(Segments along) const {
    return &tables(along).cubic_border[place(along)].table;
  }
  /// Where segments begin, and 1; rounded.
  const float* parameters(Segments along) const { return tables(along).parameters[place(along)].data(); }

  /// A strip between a border and inner points, as the ring runs: see kernel::MeshStrip.
  struct Strip {
    AlignedVector<std::uint32_t> codes;  ///< whole sixteens
    int count = 0;
  };
  const Strip& strip(Segments border, Segments inner) const {
    if (border.is_uniform() && inner.is_uniform())
      return strips_[inner.rate()][at(border.rate() + most_missing - inner.rate())];
    return other_strip(border, inner);
  }

 private:
  /// A border has at least one segment, the inner points at least two.
  static constexpr int most_missing = 1;
  static std::size_t at(int k) { return static_cast<std::size_t>(k); }
  static std::uint64_t key(Segments border, Segments inner) { return std::uint64_t{border.key()} << 32 | inner.key(); }
  void add_uniform(int degree, Segments inner, Segments border) {
    const std::uint32_t wanted = static_cast<std::uint32_t>(degree) << 26 | inner.key() << 13 | border.key();
    std::uint32_t& seen = seen_[wanted * 0x9e3779b1u >> 20];
    if (seen == wanted) return;
    add_unseen(degree, inner, border);
    seen = wanted;
  }
  /// Whatever has not been seen.
  [[gnu::cold]] void add_unseen(int degree, Segments inner, Segments border);
  void add_weights(int degree, Segments inner, Segments border);
  void add_cubic_inner(Segments along);
  void add_cubic_border(Segments along);
  void add_strip(Segments border, Segments inner);

  using BySegments = std::vector<AlignedVector<float>>;
  struct CubicInner {
    AlignedVector<float> weights;
    AlignedVector<std::int32_t> places;
    kernel::MeshCubicInner table;
  };
  struct CubicBorder {
    AlignedVector<float> weights;
    kernel::MeshCubicBorder table;
  };
  struct Tables {
    std::array<BySegments, max_degree + 1> inner, border;
    std::vector<CubicInner> cubic_inner;
    std::vector<CubicBorder> cubic_border;
    std::vector<std::vector<float>> parameters;
  };
  Tables& tables(Segments along) { return along.is_uniform() ? uniform_ : others_; }
  const Tables& tables(Segments along) const { return along.is_uniform() ? uniform_ : others_; }
  std::size_t place(Segments along) const { return along.is_uniform() ? along.rate() : other_place(along); }
  [[gnu::cold]] std::size_t other_place(Segments along) const;
  [[gnu::cold]] const Strip& other_strip(Segments border, Segments inner) const;

  bool with_cubic_;
  Tables uniform_;  ///< by rate
  Tables others_;   ///< by other_places_
  std::unordered_map<std::uint32_t, std::size_t> other_places_;
  std::array<std::uint32_t, 4096> seen_{};  ///< some of what has been added: degrees, inner and border rates
  std::vector<std::vector<Strip>> strips_;  ///< of uniform segments, `[inner][border + most_missing - inner]`
  std::unordered_map<std::uint64_t, Strip> other_strips_;
};

}  // namespace tessera
