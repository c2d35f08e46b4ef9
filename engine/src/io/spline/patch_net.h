#pragma once
// The patches of a surface as one net of control points, for formats that hold splines.

#include <array>
#include <cstddef>

#include "io/spline/model_formats.h"

namespace tessera { inline namespace abi_0_1 {

/// The patches of a surface as one net: control point (i, j) of the whole.
class PatchNet {
 public:
  explicit PatchNet(const WrittenSurface& surface)
      : surface_(surface),
        degree_u_(static_cast<std::size_t>(surface.patches.front().degree_u())),
        degree_v_(static_cast<std::size_t>(surface.patches.front().degree_v())),
        pieces_u_(surface.breaks_u.size() - 1),
        pieces_v_(surface.breaks_v.size() - 1) {}

  std::size_t count_u() const { return degree_u_ * pieces_u_ + 1; }
  std::size_t count_v() const { return degree_v_ * pieces_v_ + 1; }
  bool is_rational() const { return surface_.patches.front().is_rational(); }

  struct Place {
    const BezierPatch* patch;
    int i, j;
  };
  /// Where (i, j) is stored. On a common border, it is the patch with the smaller index.
  Place place(std::size_t i, std::size_t j) const {
    const std::size_t a = i == 0 ? 0 : (i - 1) / degree_u_, b = j == 0 ? 0 : (j - 1) / degree_v_;
    return {&surface_.patches[a * pieces_v_ + b], static_cast<int>(i - a * degree_u_),
            static_cast<int>(j - b * degree_v_)};
  }

  /// Whether each patch is its part of the net: degrees are equal, and shared borders have equal points and weights (by
  /// ==).
  bool holds_all() const {
    for (std::size_t k = 0; k < surface_.patches.size(); ++k) {
      const BezierPatch& patch = surface_.patches[k];
      if (static_cast<std::size_t>(patch.degree_u()) != degree_u_ ||
          static_cast<std::size_t>(patch.degree_v()) != degree_v_ || patch.is_rational() != is_rational())
        return false;
      if (!holds(patch, k / pieces_v_ * degree_u_, k % pieces_v_ * degree_v_)) return false;
    }
    return true;
  }

 private:
  /// Checks the first row and column, which another patch may have written.
  bool holds(const BezierPatch& patch, std::size_t first_i, std::size_t first_j) const {
    const auto same = [&](int i, int j) {
      const Place at = place(first_i + static_cast<std::size_t>(i), first_j + static_cast<std::size_t>(j));
      return at.patch->point(at.i, at.j) == patch.point(i, j) && at.patch->weight(at.i, at.j) == patch.weight(i, j);
    };
    for (int j = 0; j <= patch.degree_v(); ++j)
      if (!same(0, j)) return false;
    for (int i = 0; i <= patch.degree_u(); ++i)
      if (!same(i, 0)) return false;
    return true;
  }

  const WrittenSurface& surface_;
  std::size_t degree_u_, degree_v_, pieces_u_, pieces_v_;
};

/// Calls write(WrittenSurface) for the surface if its patches make a net, else for one patch after the other, without
/// trims. Returns false if the surface has trims that are left out.
template <class Write>
bool write_as_nets(const WrittenSurface& surface, const OutputFile& out, Write write) {
  if (PatchNet(surface).holds_all()) {
    write(surface);
    return true;
  }
  for (std::size_t k = 0; k < surface.patches.size() && !out.failed(); ++k) {
    const Domain domain = surface.patch_domain(k);
    const std::array breaks_u{domain.u0, domain.u1}, breaks_v{domain.v0, domain.v1};
    write(WrittenSurface{surface.name, breaks_u, breaks_v, surface.patches.subspan(k, 1), {}});
  }
  return surface.trims.empty();
}

}}  // namespace tessera::abi_0_1
