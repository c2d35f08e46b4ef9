#pragma once
// What the meshes of many patches share: weights, parameters and strips of triangles of each rate that is in use.

#include <array>
#include <cstdint>
#include <span>
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
      const bool along_u = runs_along_u(side);
      add(along_u ? degree_u : degree_v, along_u ? division.inner.u : division.inner.v,
          division.border[static_cast<std::size_t>(side)]);
    }
  }

  // Once added. Layouts: see kernel::MeshVertexJob and MeshBorder. Weights are rounded once, to float.
  const float* inner_weights(int degree, int rate) const { return inner_[at(degree)][at(rate)].data(); }
  const float* border_weights(int degree, int rate) const { return border_[at(degree)][at(rate)].data(); }
  /// See kernel::MeshVertexJob::points.
  const kernel::MeshCubicInner* cubic_inner(int rate) const { return &cubic_inner_[at(rate)].table; }
  const kernel::MeshCubicBorder* cubic_border(int rate) const { return &cubic_border_[at(rate)].table; }
  /// k / rate, k = 0 .. rate, rounded.
  const float* parameters(int rate) const { return parameters_[at(rate)].data(); }

  /// A strip between a border of a rate and inner points of another: see kernel::MeshStrip.
  struct Strip {
    AlignedVector<std::uint32_t> codes;  ///< whole sixteens
    int count = 0;
  };
  const Strip& strip(int border, int inner) const { return strips_[at(inner)][at(border + most_missing - inner)]; }

 private:
  /// A border has at least one segment, the inner points at least two.
  static constexpr int most_missing = 1;
  static std::size_t at(int k) { return static_cast<std::size_t>(k); }
  void add(int degree, int inner, int border) {
    const std::uint32_t key = (static_cast<std::uint32_t>(degree) << 26) + (static_cast<std::uint32_t>(inner) << 13) +
                              static_cast<std::uint32_t>(border);
    std::uint32_t& seen = seen_[key * 0x9e3779b1u >> 20];
    if (seen == key) return;
    add_weights(degree, inner, border);
    if (inner > 1) add_strip(border, inner);
    seen = key;
  }
  void add_weights(int degree, int inner, int border);
  void add_cubic_inner(int rate);
  void add_cubic_border(int rate);
  void add_strip(int border, int inner);

  using ByRate = std::vector<AlignedVector<float>>;
  std::array<ByRate, max_degree + 1> inner_, border_;
  struct CubicInner {
    AlignedVector<float> weights;
    AlignedVector<std::int32_t> places;
    kernel::MeshCubicInner table;
  };
  struct CubicBorder {
    AlignedVector<float> weights;
    kernel::MeshCubicBorder table;
  };
  bool with_cubic_;
  std::vector<CubicInner> cubic_inner_;
  std::vector<CubicBorder> cubic_border_;
  std::vector<std::vector<float>> parameters_;
  std::array<std::uint32_t, 4096> seen_{};  ///< some of what has been added: degrees, inner and border rates
  std::vector<std::vector<Strip>> strips_;  ///< `[inner][border + most_missing - inner]`
};

}  // namespace tessera
