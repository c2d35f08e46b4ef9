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

namespace tessera { inline namespace abi_0_1 {

/// Tables that are looked up by number while a mesh is written. Rates are at most 4096.
class MeshTables {
 public:
  /// Returns tables that hold all that the patches of a set need for these divisions.
  ///
  /// The tables of a small mesh take longer to make than its vertices, so the set keeps the common ones for all of its
  /// plans. `with_points`: for kernels that have mesh_points. Threads: any number.
  static std::shared_ptr<const MeshTables> of(const PatchSet::Impl& set, std::span<const Division> divisions,
                                              bool with_points);
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
  /// Whether kernels that have mesh_points take a patch by these: it has cubic weights then, otherwise plain ones.
  /// Graded segments have plain weights, because few patches share them and cubic weights take seven times the memory.
  static bool takes_points(const BlockGroup& group, const Division& division);
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
  friend class SeenBorders;
  MeshTables() = default;

  /// The most by which a border has fewer segments than the inner points: a patch with one segment gets two of these.
  static constexpr int max_missing = 1;
  static std::size_t at(int k) { return static_cast<std::size_t>(k); }
  static bool is_common(Segments border, Segments inner, bool collapsed) {
    return border.is_uniform() && inner.is_uniform() && !collapsed;
  }
  struct StripKey {
    Segments border, inner;
    bool collapsed;
    friend bool operator==(const StripKey&, const StripKey&) = default;
  };
  struct Hash {
    std::size_t operator()(std::uint64_t key) const {
      return static_cast<std::size_t>((key ^ key >> 32) * 0x9e3779b97f4a7c15u >> 20);
    }
    std::size_t operator()(const StripKey& key) const {
      return (*this)(key.border.key() * 3 + key.inner.key() + std::uint64_t{key.collapsed});
    }
  };

  /// A border of a patch and the inner points beside it.
  struct Border {
    int degree;      ///< the degree along the border
    bool by_points;  ///< see takes_points()
    bool backward;   ///< whether the ring of border points runs against the parameter
    bool collapsed;
    Segments inner, border;  ///< in the direction of the parameter
    Segments ring_inner() const { return backward ? inner.reversed() : inner; }
    Segments ring_border() const { return backward ? border.reversed() : border; }
  };
  /// Whether the tables hold all that a border of a patch needs; add() adds it.
  bool has(const Border& wanted) const;
  void add(const Border& wanted);
  bool has_weights(const Border& wanted) const;
  void add_parameters(Segments along);
  void add_inner(const Border& wanted);
  void add_border(const Border& wanted);
  void add_strip(Segments border, Segments inner, bool collapsed);
  kernel::MeshCubicInner make_cubic_inner(Segments along);
  kernel::MeshCubicBorder make_cubic_border(Segments along);
  /// Keeps a table in memory that copies of this object share, and returns it.
  template <class T>
  const T* hold(const AlignedVector<T>& made);

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

  Tables uniform_;                                                     ///< by rate
  Tables others_;                                                      ///< by other_places_
  std::unordered_map<std::uint64_t, std::size_t, Hash> other_places_;  ///< by Segments::key()
  std::vector<std::vector<Strip>> strips_;  ///< common ones, `[inner][border + max_missing - inner]`
  std::unordered_map<StripKey, Strip, Hash> other_strips_;
  using Chunk = UnsetVector<float>;
  std::vector<std::shared_ptr<Chunk>> memory_;  ///< owns all that the pointers above refer to
  /// The rest of the last chunk. A copy begins a chunk of its own, because both may add tables.
  struct Room {
    float* begin = nullptr;
    std::size_t floats = 0;
    std::size_t next_chunk = 256;  ///< floats of the next chunk, which doubles up to 16 KiB

    Room() = default;
    Room(const Room&) {}
    Room& operator=(const Room&) = delete;
  };
  Room room_;
  std::size_t bytes_ = 0;
};

}}  // namespace tessera::abi_0_1
