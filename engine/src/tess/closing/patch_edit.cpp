#include "tess/closing/patch_edit.h"

#include <algorithm>
#include <unordered_map>

namespace tessera { inline namespace abi_0_1 {
namespace {

using Triangle = CutPatch::Triangle;

/// A segment from one vertex to another as the key of a table.
std::uint64_t key(std::uint32_t from, std::uint32_t to) { return std::uint64_t{from} << 32 | to; }

/// The triangles that have given segments as sides, in the direction of the triangle.
class SideOwners {
 public:
  /// A triangle, and its corner where the side starts.
  struct Side {
    std::uint32_t triangle = no_id;
    std::size_t corner = 0;
    bool exists() const { return triangle != no_id; }
  };

  explicit SideOwners(FunctionRef<std::uint32_t(std::uint32_t)> pole) : pole_(pole) {}
  void want(std::uint32_t from, std::uint32_t to) {
    owners_.emplace(key(pole_(from), pole_(to)), Side{});
    owners_.emplace(key(pole_(to), pole_(from)), Side{});
  }
  void note(const Triangle& triangle, std::uint32_t index) {
    for (std::size_t c = 0; c < 3; ++c) {
      const auto owner = owners_.find(key(pole_(triangle[c]), pole_(triangle[(c + 1) % 3])));
      if (owner != owners_.end()) owner->second = {index, c};
    }
  }
  Side of(std::uint32_t from, std::uint32_t to) const { return owners_.at(key(pole_(from), pole_(to))); }

 private:
  FunctionRef<std::uint32_t(std::uint32_t)> pole_;
  std::unordered_map<std::uint64_t, Side> owners_;
};

/// Replaces a triangle with a side by the fan of its parts. `inside`: the vertices along the side.
void divide(SideOwners::Side side, std::span<const std::uint32_t> inside, std::vector<Triangle>& triangles,
            SideOwners& owners) {
  const Triangle whole = triangles[side.triangle];
  const std::uint32_t a = whole[side.corner], b = whole[(side.corner + 1) % 3], apex = whole[(side.corner + 2) % 3];
  triangles[side.triangle] = {a, inside.front(), apex};
  owners.note(triangles[side.triangle], side.triangle);
  for (std::size_t k = 0; k < inside.size(); ++k) {
    triangles.push_back({inside[k], k + 1 < inside.size() ? inside[k + 1] : b, apex});
    owners.note(triangles.back(), static_cast<std::uint32_t>(triangles.size() - 1));
  }
}

}  // namespace

std::vector<std::uint32_t> insert_vertices(std::span<const InsertedVertex> inserted, std::uint32_t first,
                                           FunctionRef<std::uint32_t(std::uint32_t)> pole,
                                           std::vector<Triangle>& triangles) {
  SideOwners owners(pole);
  for (const InsertedVertex& vertex : inserted) owners.want(vertex.start, vertex.end);
  for (std::uint32_t k = 0; k < triangles.size(); ++k) owners.note(triangles[k], k);
  const auto count = static_cast<std::uint32_t>(triangles.size());
  std::vector<std::uint32_t> changed, inside;
  for (std::size_t k = 0; k < inserted.size();) {
    const std::uint32_t start = inserted[k].start, end = inserted[k].end;
    inside.clear();
    for (; k < inserted.size() && inserted[k].start == start && inserted[k].end == end; ++k)
      inside.push_back(first + static_cast<std::uint32_t>(k));
    SideOwners::Side side = owners.of(start, end);
    if (!side.exists()) {
      side = owners.of(end, start);
      std::ranges::reverse(inside);
    }
    if (!side.exists()) continue;
    if (side.triangle < count) changed.push_back(side.triangle);
    divide(side, inside, triangles, owners);
  }
  std::ranges::sort(changed);
  changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
  return changed;
}

}}  // namespace tessera::abi_0_1
