#pragma once
// The parameters that vertices of a mesh have: those of patches, or of the surfaces that patches came from.

#include <cstddef>
#include <vector>

#include "block/patch_set_impl.h"
#include "tessera/geometry.h"
#include "tessera/strided_view.h"
#include "tessera/tessellation_options.h"

namespace tessera { inline namespace abi_0_1 {

/// Maps the parameters of a patch, [0,1]^2, to a rectangle. Sides go to its sides to the bit, so that neighbours agree.
struct ParameterMap {
  Domain to = {};

  void put(const View2<float>& view, std::size_t vertex, float u, float v) const {
    view.at(vertex, 0) = static_cast<float>(to.u_at(double(u)));
    view.at(vertex, 1) = static_cast<float>(to.v_at(double(v)));
  }

  /// Calls write(put), where put(vertex, u, v) does what put() does: at full speed where patches keep their own.
  template <class Write>
  void with_put(const View2<float>& view, Write&& write) const {
    const auto keep = [view](std::size_t vertex, float u, float v) { view.at(vertex, 0) = u, view.at(vertex, 1) = v; };
    to == Domain{} ? write(keep) : write([&](std::size_t vertex, float u, float v) { put(view, vertex, u, v); });
  }
};

/// The map of each patch of a set, which must outlive this object.
class ParameterMaps {
 public:
  ParameterMaps(const PatchSet::Impl& set, VertexParameters kind);

  ParameterMap of(std::size_t patch) const;
  /// Whether two points of patches, in [0,1]^2, have the same parameters of one surface, up to rounding.
  bool agree(std::size_t patch, const ParameterPoint& at, std::size_t other, const ParameterPoint& other_at) const;

 private:
  const PatchSet::Impl& set_;
  VertexParameters kind_;
  std::vector<Domain> domains_;  ///< `[surface]`: that of its patches; only for VertexParameters::unit
};

}}  // namespace tessera::abi_0_1
