#include "ray/border/adjacency.h"

#include <algorithm>
#include <bit>

namespace tessera { inline namespace abi_0_1 {
namespace {

/// One border of a patch as a sequence of control points.
struct Border {
  const BezierPatch* patch;
  int edge;

  int size() const { return (edge < 2 ? patch->degree_v() : patch->degree_u()) + 1; }
  int row(int k) const { return edge < 2 ? (edge == 0 ? 0 : patch->degree_u()) : k; }
  int column(int k) const { return edge < 2 ? k : (edge == 2 ? 0 : patch->degree_v()); }
  const Vec3& point(int k) const { return patch->point(row(k), column(k)); }
  double weight(int k) const { return patch->weight(row(k), column(k)); }
};

bool same(const Border& a, const Border& b, bool reversed) {
  const int size = a.size();
  if (b.size() != size) return false;
  for (int k = 0; k < size; ++k) {
    const int other = reversed ? size - 1 - k : k;
    if (!(a.point(k) == b.point(other)) || a.weight(k) != b.weight(other)) return false;
  }
  return true;
}

std::uint64_t mix(std::uint64_t hash, double value) {
  hash ^= std::bit_cast<std::uint64_t>(value + 0.0);  // -0 and 0 are equal
  hash *= 0x9e3779b97f4a7c15u;
  return hash ^ (hash >> 29);
}

/// Returns a hash that is the same for both directions: the sum of the two directions' hashes.
std::uint64_t hash(const Border& border) {
  std::uint64_t forward = 1, backward = 1;
  const int last = border.size() - 1;
  for (int k = 0; k <= last; ++k) {
    const Vec3 &p = border.point(k), &q = border.point(last - k);
    forward = mix(mix(mix(mix(forward, p.x), p.y), p.z), border.weight(k));
    backward = mix(mix(mix(mix(backward, q.x), q.y), q.z), border.weight(last - k));
  }
  return forward + backward;
}

struct Entry {
  std::uint64_t hash;
  std::uint32_t patch;
  std::uint8_t edge;
};

}  // namespace

Adjacency::Adjacency(const SetView& set) : links_(set.patch_count()) {
  std::vector<Entry> entries;
  entries.reserve(4 * set.patch_count());
  for (std::uint32_t k = 0; k < set.patch_count(); ++k) {
    const SideMask collapsed = set.collapsed_sides(k);
    for (std::uint8_t edge = 0; edge < 4; ++edge) {
      if (!collapsed.has(link_sides[edge])) entries.push_back({hash({&set.patch(k), edge}), k, edge});
    }
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.hash != b.hash ? a.hash < b.hash : a.patch != b.patch ? a.patch < b.patch : a.edge < b.edge;
  });
  // Equal edges lie in runs of equal hashes. A run of other than two edges is a border, a branching or a collision.
  for (std::size_t begin = 0, end = 0; begin < entries.size(); begin = end) {
    while (end < entries.size() && entries[end].hash == entries[begin].hash) ++end;
    if (end - begin != 2) continue;
    const Entry &a = entries[begin], &b = entries[begin + 1];
    const Border first{&set.patch(a.patch), a.edge}, second{&set.patch(b.patch), b.edge};
    const bool forward = same(first, second, false);
    if (!forward && !same(first, second, true)) continue;
    links_[a.patch][a.edge] = {b.patch, b.edge, !forward};
    links_[b.patch][b.edge] = {a.patch, a.edge, !forward};
  }
}

}}  // namespace tessera::abi_0_1
