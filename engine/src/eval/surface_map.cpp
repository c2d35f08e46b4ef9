#include <string>

#include "base/impl_access.h"
#include "block/patch_set_impl.h"
#include "eval/surface_map_impl.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Reads breakpoints from the first row and the first column of patches [begin, end), then looks at all of them.
bool read_grid(std::span<const PatchSource> patches, SurfaceMap::Impl::Surface& surface) {
  const Domain& first = patches.front().domain;
  surface.breaks_u = {first.u0};
  surface.breaks_v = {first.v0};
  std::size_t row = 0;  // patches of a row
  while (row < patches.size() && patches[row].domain.u0 == first.u0)
    surface.breaks_v.push_back(patches[row++].domain.v1);
  for (std::size_t k = 0; k < patches.size(); k += row) surface.breaks_u.push_back(patches[k].domain.u1);
  if (patches.size() % row != 0) return false;
  for (std::size_t k = 0; k < patches.size(); ++k) {
    const std::size_t a = k / row, b = k % row;
    const Domain expected{surface.breaks_u[a], surface.breaks_u[a + 1], surface.breaks_v[b], surface.breaks_v[b + 1]};
    if (!(patches[k].domain == expected)) return false;
  }
  return true;
}

}  // namespace

Result<SurfaceMap> SurfaceMap::make(const PatchSet& set) {
  return guarded([&]() -> Result<SurfaceMap> {
    const std::vector<PatchSource>& sources = impl_of(set).sources;
    auto map = std::make_unique<Impl>();
    map->patch_count = sources.size();
    map->surfaces.resize(set.surface_count());
    for (std::size_t begin = 0; begin < sources.size();) {
      const std::uint32_t surface = sources[begin].surface;
      std::size_t end = begin;
      while (end < sources.size() && sources[end].surface == surface) ++end;
      Impl::Surface& found = map->surfaces[surface];
      if (!found.breaks_u.empty() || !read_grid(std::span(sources).subspan(begin, end - begin), found))
        return Status(StatusCode::unsupported,
                      "the patches of surface " + std::to_string(surface) +
                          " are not those of one grid of rectangles, in its order",
                      static_cast<std::ptrdiff_t>(surface));
      found.first_patch = begin;
      begin = end;
    }
    return SurfaceMap(std::move(map));
  });
}

SurfaceMap::SurfaceMap(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SurfaceMap::SurfaceMap(SurfaceMap&&) noexcept = default;
SurfaceMap& SurfaceMap::operator=(SurfaceMap&&) noexcept = default;
SurfaceMap::~SurfaceMap() = default;

std::size_t SurfaceMap::surface_count() const { return impl_->surfaces.size(); }
std::optional<Domain> SurfaceMap::domain(std::size_t surface) const {
  const Impl::Surface& of = impl_->surfaces[surface];
  if (of.breaks_u.empty()) return {};
  return of.domain();
}

}}  // namespace tessera::abi_0_1
