#include "tess/closing/patch_edit.h"

#include <algorithm>
#include <unordered_map>

namespace tessera::inline abi_0_1 {
namespace {

using Triangle = CutPatch::Triangle;

/// A segment from one vertex to another as the key of a table.
std::uint64_t key(std::uint32_t from, std::uint32_t to) { return std::uint64_t{from} << 32 | to; }

/// The triangles that have given segments as sides, in the direction of the triangle.
class SideOwners {
 public:
  void want(std::uint32_t from, std::uint32_t to) {
    owners_.emplace(key(from, to), CutPatch::none);
    owners_.emplace(key(to, from), CutPatch::none);
  }
  void note(const Triangle& triangle, std::uint32_t index) {
    for (std::size_t c = 0; c < 3; ++c) {
      const auto owner = owners_.find(key(triangle[c], triangle[(c + 1) % 3]));
      if (owner != owners_.end()) owner->second = index;
    }
  }
  std::uint32_t of(std::uint32_t from, std::uint32_t to) const { return owners_.at(key(from, to)); }

 private:
  std::unordered_map<std::uint64_t, std::uint32_t> owners_;
};

/// Replaces a triangle with the side from `a` to `b` by the fan of its parts. `inside`: the vertices from a to b.
void divide(std::uint32_t owner, std::uint32_t a, std::uint32_t b, std::span<const std::uint32_t> inside,
            std::vector<Triangle>& triangles, SideOwners& owners) {
  std::uint32_t apex = 0;
  for (const std::uint32_t corner : triangles[owner])
    if (corner != a && corner != b) apex = corner;
  triangles[owner] = {a, inside.front(), apex};
  owners.note(triangles[owner], owner);
  for (std::size_t k = 0; k < inside.size(); ++k) {
    triangles.push_back({inside[k], k + 1 < inside.size() ? inside[k + 1] : b, apex});
    owners.note(triangles.back(), static_cast<std::uint32_t>(triangles.size() - 1));
  }
}

}  // namespace

std::vector<std::uint32_t> insert_vertices(std::span<const InsertedVertex> inserted, std::uint32_t first,
                                           std::vector<Triangle>& triangles) {
  SideOwners owners;
  for (const InsertedVertex& vertex : inserted) owners.want(vertex.start, vertex.end);
  for (std::uint32_t k = 0; k < triangles.size(); ++k) owners.note(triangles[k], k);
  const auto count = static_cast<std::uint32_t>(triangles.size());
  std::vector<std::uint32_t> changed;
  const auto divide_owner = [&](std::uint32_t owner, std::uint32_t a, std::uint32_t b,
                                std::span<const std::uint32_t> at) {
    if (owner < count) changed.push_back(owner);
    divide(owner, a, b, at, triangles, owners);
  };
  std::vector<std::uint32_t> inside;
  for (std::size_t k = 0; k < inserted.size();) {
    const std::uint32_t start = inserted[k].start, end = inserted[k].end;
    inside.clear();
    for (; k < inserted.size() && inserted[k].start == start && inserted[k].end == end; ++k)
      inside.push_back(first + static_cast<std::uint32_t>(k));
    if (const std::uint32_t owner = owners.of(start, end); owner != CutPatch::none) {
      divide_owner(owner, start, end, inside);
    } else if (const std::uint32_t other = owners.of(end, start); other != CutPatch::none) {
      std::ranges::reverse(inside);
      divide_owner(other, end, start, inside);
    }
  }
  std::ranges::sort(changed);
  changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
  return changed;
}

}  // namespace tessera::inline abi_0_1
