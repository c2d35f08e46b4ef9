#pragma once
// Heights along the pieces of loops that cut a patch.

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "section/height_line.h"
#include "section/height_patch.h"
#include "trim/trim_region_impl.h"

namespace tessera { inline namespace abi_0_1 {

/// Heights where pieces of a face meet: the first that is found counts for all pieces that end there.
class LoopVertices {
 public:
  double height(const ParameterPoint& at, double found) {
    return heights_.try_emplace(Key{at.u + 0.0, at.v + 0.0}, found).first->second;
  }

 private:
  struct Key {
    double u, v;
    friend bool operator==(const Key&, const Key&) = default;
  };
  struct Hash {
    std::size_t operator()(const Key& key) const {
      return static_cast<std::size_t>(std::hash<double>()(key.u) * 0x9e3779b97f4a7c15u + std::hash<double>()(key.v));
    }
  };
  std::unordered_map<Key, double, Hash> heights_;
};

/// Where a plane meets a loop within a patch.
struct LoopHit {
  std::uint32_t piece = 0;     ///< of the region's pieces
  std::uint32_t interval = 0;  ///< of the piece's line
  double place = 0;            ///< of the piece, from 0 to 1
  ParameterPoint at = {};      ///< in the patch's parameters from 0 to 1
};

/// The pieces that cut one patch.
class LoopLines {
 public:
  /// `domain`: of the patch in the region's parameters; `pieces`: those that cut it. The region must outlive this.
  LoopLines(const BezierPatch& patch, const Domain& domain, const TrimRegion& region,
            std::span<const std::uint32_t> pieces, const Levels& levels, LoopVertices& vertices);

  /// Finds where a plane meets the pieces. Returns whether the end of an interval of a piece is within `contact` of it.
  bool find(const Level& level, double contact, std::vector<LoopHit>& hits) const;
  TrimSide locate(const ParameterPoint& at) const { return region_->locate(domain_.u_at(at.u), domain_.v_at(at.v)); }
  /// Whether all points of pieces are proven to be found.
  bool is_proven() const { return is_proven_; }

 private:
  const TrimRegion* region_;
  Domain domain_;
  std::vector<std::uint32_t> pieces_;
  std::vector<HeightLine> lines_;  ///< by pieces_
  bool is_proven_ = true;
};

/// Returns heights times weights, and weights, along a curve in the patch's parameters. Both have the degree of the
/// curve times the sum of the patch's degrees.
std::pair<std::vector<double>, std::vector<double>> heights_along(const BezierPatch& patch, const Domain& domain,
                                                                  const PlaneBezier& curve, const Levels& levels);

}}  // namespace tessera::abi_0_1
