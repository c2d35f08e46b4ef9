#pragma once
// Holds the weights, parameters and strips of triangles that meshes of many patches share, for all segments in use.

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "base/aligned.h"
#include "block/patch_set_impl.h"
#include "kernel/mesh/mesh_kernels.h"
#include "tess/cells/stitched_patch.h"
#include "tessera/bezier_patch.h"

namespace tessera::inline abi_0_1 {

/// Tables that are looked up by number while a mesh is written. Rates are at most 4096.
class MeshTables {
 public:
  /// Returns tables that hold all that patches of these shapes and divisions need.
  ///
  /// The tables of a small mesh take longer to make than its vertices, so the set keeps the common ones for all of its
  /// plans. `with_cubic`: also those for kernels that take bicubic patches point by point. Threads: any
  /// number.
  static std::shared_ptr<const MeshTables> of(const PatchSet::Impl& set, std::span<const PatchShape> shapes,
                                              std::span<const Division> divisions, bool with_cubic);
  /// Tables of more bytes are not shared by plans.
  static constexpr std::size_t max_common_bytes = std::size_t{1} << 18;
  std::size_t bytes() const { return bytes_; }  ///< approximately

  // For layouts see kernel::MeshVertexJob and MeshBorder. Weights are rounded once, to float.
  const float* inner_weights(int degree, Segments along) const { return tables(along).inner[at(degree)][place(along)]; }
  const float* border_weights(int degree, Segments along) const {
    return tables(along).border[at(degree)][place(along)];
  }
  /// See kernel::MeshVertexJob::points.
  const kernel::MeshCubicInner* cubic_inner(Segments along) const { return &tables(along).cubic_inner[place(along)]; }
  const kernel::MeshCubicBorder* cubic_border(Segments along) const {
    return &tables(along).cubic_border[place(along)];
  }
  /// Returns where segments begin, and 1; rounded to float.
  const float* parameters(Segments along) const { return tables(along).parameters[place(along)]; }

  /// A strip between a border and inner points, in the direction of the ring: see kernel::MeshStrip.
  struct Strip {
    const std::uint32_t* codes = nullptr;  ///< padded to a multiple of 16
    int count = 0;
  };
  Strip strip(Segments border, Segments inner, bool collapsed) const {
    if (is_common(border, inner, collapsed))
      return strips_[at(inner.rate())][at(border.rate() + max_missing - inner.rate())];
    return other_strip(border, inner, collapsed);
  }

 private:
  friend class TableMaker;
  explicit MeshTables(bool with_cubic) : with_cubic_(with_cubic) {}

  /// The most by which a border has fewer segments than the inner points: a patch with one segment gets two of these.
  static constexpr int max_missing = 1;
  static std::size_t at(int k) { return static_cast<std::size_t>(k); }
  static bool is_common(Segments border, Segments inner, bool collapsed) {
    return border.is_uniform() && inner.is_uniform() && !collapsed;
  }
  /// Returns a key of a strip. Keys of segments are below 2^26.
  static std::uint64_t key(Segments border, Segments inner, bool collapsed) {
    return std::uint64_t{border.key()} << 32 | std::uint64_t{collapsed} << 31 | inner.key();
  }

  /// Whether the tables hold all that a border of a patch needs; add() adds it. Segments are in the direction of the
  /// ring, the degree is that along the border.
  bool has(int degree, Segments inner, Segments border, bool collapsed) const;
  void add(int degree, Segments inner, Segments border, bool collapsed);
  void add_parameters(Segments along);
  void add_inner(int degree, Segments along);
  void add_border(int degree, Segments along);
  void add_strip(Segments border, Segments inner, bool collapsed);
  kernel::MeshCubicInner make_cubic_inner(Segments along);
  kernel::MeshCubicBorder make_cubic_border(Segments along);
  /// Keeps a table in memory that copies of this object share, and returns it.
  template <class T>
  const T* hold(AlignedVector<T> made);

  struct Tables {
    std::array<std::vector<const float*>, max_degree + 1> inner, border;
    std::vector<kernel::MeshCubicInner> cubic_inner;
    std::vector<kernel::MeshCubicBorder> cubic_border;
    std::vector<const float*> parameters;
  };
  Tables& tables(Segments along) { return along.is_uniform() ? uniform_ : others_; }
  const Tables& tables(Segments along) const { return along.is_uniform() ? uniform_ : others_; }
  std::size_t place(Segments along) const { return along.is_uniform() ? at(along.rate()) : other_place(along); }
  [[gnu::cold]] std::size_t other_place(Segments along) const;
  [[gnu::cold]] Strip other_strip(Segments border, Segments inner, bool collapsed) const;

  bool with_cubic_;
  Tables uniform_;  ///< by rate
  Tables others_;   ///< by other_places_
  std::unordered_map<std::uint32_t, std::size_t> other_places_;
  std::vector<std::vector<Strip>> strips_;  ///< common ones, `[inner][border + max_missing - inner]`
  std::unordered_map<std::uint64_t, Strip> other_strips_;
  std::vector<std::shared_ptr<const void>> memory_;  ///< owns all that the pointers above refer to
  std::size_t bytes_ = 0;
};

}  // namespace tessera::inline abi_0_1
