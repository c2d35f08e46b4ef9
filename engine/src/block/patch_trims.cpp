#include "block/patch_trims.h"

#include <algorithm>

#include "base/impl_access.h"
#include "trim/trim_region_impl.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Makes whole patches cut ones where a piece ends inside one of their sides and does not run along it.
class TouchedSides {
 public:
  TouchedSides(const TrimRegion::Impl& region, std::vector<PatchUse>& uses) : region_(region), uses_(uses) {}

  /// `at`: an end of a piece, `other`: its other end.
  void touch(const ParameterPoint& at, const ParameterPoint& other) {
    const std::vector<double>&u = region_.lines.u.lines, &v = region_.lines.v.lines;
    const auto line_u = std::ranges::lower_bound(u, at.u), line_v = std::ranges::lower_bound(v, at.v);
    const bool on_u = line_u != u.end() && *line_u == at.u, on_v = line_v != v.end() && *line_v == at.v;
    if (on_u == on_v) return;  // inside a patch, or a corner
    if (on_u ? at.u == other.u : at.v == other.v) return;
    const std::ptrdiff_t a = line_u - u.begin(), b = line_v - v.begin();
    cut(a - 1, b - 1);
    on_u ? cut(a, b - 1) : cut(a - 1, b);
  }

 private:
  void cut(std::ptrdiff_t a, std::ptrdiff_t b) {
    const auto count_u = std::ssize(region_.lines.u.lines) - 1, count_v = std::ssize(region_.lines.v.lines) - 1;
    if (a < 0 || b < 0 || a >= count_u || b >= count_v) return;
    PatchUse& use = uses_[static_cast<std::size_t>(a * count_v + b)];
    if (use == PatchUse::whole) use = PatchUse::cut;
  }

  const TrimRegion::Impl& region_;
  std::vector<PatchUse>& uses_;
};

}  // namespace

std::vector<PatchUse> patch_uses(const TrimRegion& region) {
  const TrimRegion::Impl& impl = impl_of(region);
  std::vector<PatchUse> uses;
  uses.reserve(impl.patches.size());
  for (const TrimSide side : impl.patches)
    uses.push_back(side == TrimSide::inside    ? PatchUse::whole
                   : side == TrimSide::outside ? PatchUse::out
                                               : PatchUse::cut);
  TouchedSides touched(impl, uses);
  for (const TrimPiece& piece : impl.pieces) {
    touched.touch(piece.start(), piece.end());
    touched.touch(piece.end(), piece.start());
  }
  return uses;
}

}}  // namespace tessera::abi_0_1
