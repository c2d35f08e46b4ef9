#include "tess/cells/parameter_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Returns the smallest rectangle around the patches of each surface.
std::vector<Domain> domains_of_patches(const PatchSet::Impl& set) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::vector<Domain> domains(set.surface_count, {infinity, -infinity, infinity, -infinity});
  for (const PatchSource& source : set.sources) {
    Domain& all = domains[source.surface];
    all.u0 = std::min(all.u0, source.domain.u0), all.u1 = std::max(all.u1, source.domain.u1);
    all.v0 = std::min(all.v0, source.domain.v0), all.v1 = std::max(all.v1, source.domain.v1);
  }
  return domains;
}

}  // namespace

ParameterMaps::ParameterMaps(const PatchSet::Impl& set, VertexParameters kind) : set_(set), kind_(kind) {
  if (kind == VertexParameters::unit) domains_ = set.domains.empty() ? domains_of_patches(set) : set.domains;
}

ParameterMap ParameterMaps::of(std::size_t patch) const {
  if (kind_ == VertexParameters::patch) return {};
  const auto& [surface, d] = set_.sources[patch];
  if (kind_ == VertexParameters::surface) return {d};
  const Domain& all = domains_[surface];
  return {{all.local_u(d.u0), all.local_u(d.u1), all.local_v(d.v0), all.local_v(d.v1)}};
}

bool ParameterMaps::agree(std::size_t patch, const ParameterPoint& at, std::size_t other,
                          const ParameterPoint& other_at) const {
  if (set_.sources[patch].surface != set_.sources[other].surface) return false;
  constexpr double near = 0x1p-16;  // of a patch: above the rounding of floats, far below a segment
  const Domain &d = set_.sources[patch].domain, &e = set_.sources[other].domain;
  return std::abs(d.u_at(at.u) - e.u_at(other_at.u)) <= near * std::min(d.u1 - d.u0, e.u1 - e.u0) &&
         std::abs(d.v_at(at.v) - e.v_at(other_at.v)) <= near * std::min(d.v1 - d.v0, e.v1 - e.v0);
}

}}  // namespace tessera::abi_0_1
