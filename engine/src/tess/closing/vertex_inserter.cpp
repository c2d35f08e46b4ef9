#include "tess/closing/vertex_inserter.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "parallel/parallel_for.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::size_t edited_patches_per_task = 16;

/// Returns the first vertex of a division's ring at the place of this one: another one where it lies on collapsed
/// borders.
std::uint32_t first_at_pole(const Division& division, std::uint32_t vertex) {
  const auto first = static_cast<std::uint32_t>(division.inner_count()),
             end = static_cast<std::uint32_t>(division.vertex_count());
  if (!division.collapsed.any() || vertex < first || vertex >= end) return vertex;
  if (division.has_one_corner()) return first;
  const auto is_pole = [&](std::size_t side) { return division.collapsed.has(all_sides[side]); };
  const auto count = [&](std::size_t side) { return static_cast<std::uint32_t>(division.border[side].rate()); };
  std::size_t side = 0;
  std::uint32_t start = first;  // of the side
  for (; side < 3 && vertex - start >= count(side); ++side) start += count(side);
  if (vertex != start && !is_pole(side)) return vertex;
  for (std::size_t before; is_pole(before = (side + 3) % 4); side = before)  // back along the ring
    start = (side == 0 ? end : start) - count(before);
  return start;
}

/// Divides the triangles of a cut patch. Returns the number of the first new vertex.
std::uint32_t divide_cut(std::span<const InsertedVertex> inserted, const ChordBound& chord, CutPatch& cut) {
  const auto first = static_cast<std::uint32_t>(cut.vertices.size());
  for (const InsertedVertex& vertex : inserted) cut.vertices.push_back(vertex.local);
  const std::size_t count = cut.triangles.size();
  // A chord's sliver, and that of its parts beside it, unless these lie within.
  if (std::ranges::any_of(inserted, &InsertedVertex::widens_sliver)) cut.sliver *= 2;
  const auto itself = [](std::uint32_t vertex) { return vertex; };  // cut patches have one vertex at a pole
  for (const std::uint32_t k : insert_vertices(inserted, first, itself, cut.triangles))
    cut.measure(cut.triangles[k], chord);
  for (std::size_t k = count; k < cut.triangles.size(); ++k) cut.measure(cut.triangles[k], chord);
  return first;
}

/// Finds how the triangles of a whole patch are divided. Returns the number of the first new vertex.
std::uint32_t divide_whole(std::span<const InsertedVertex> inserted, const Division& division, PatchEdit& edit) {
  const auto first = static_cast<std::uint32_t>(division.vertex_count());
  const std::size_t count = division.triangle_count() - 2 * division.cell_count();  // cells are not on borders
  std::vector<CutPatch::Triangle> triangles(count);
  division.write_triangles(0, triangles.data()->data(), false);
  edit.patch = inserted.front().patch;
  for (const InsertedVertex& vertex : inserted) edit.vertices.push_back(vertex.local);
  const auto pole = [&](std::uint32_t vertex) { return first_at_pole(division, vertex); };
  for (const std::uint32_t k : insert_vertices(inserted, first, pole, triangles))
    edit.changed.emplace_back(k, triangles[k]);
  edit.added.assign(triangles.begin() + static_cast<std::ptrdiff_t>(count), triangles.end());
  return first;
}

}  // namespace

Result<DividedTriangles> divide_triangles(std::span<const InsertedVertex> inserted,
                                          std::span<const std::uint8_t> is_used, std::span<const Division> divisions,
                                          std::span<CutPatch> cuts, FunctionRef<ChordBound(std::uint32_t patch)> chord,
                                          const std::atomic<bool>* cancel) {
  DividedTriangles out;
  out.numbers.assign(inserted.size(), no_id);
  std::vector<std::uint32_t> order;
  for (std::uint32_t k = 0; k < inserted.size(); ++k)
    if (is_used[k]) order.push_back(k);
  std::ranges::sort(order, {}, [&](std::uint32_t k) { return std::tuple_cat(inserted[k].place(), std::tuple(k)); });
  std::vector<InsertedVertex> sorted;
  for (const std::uint32_t k : order) sorted.push_back(inserted[k]);
  std::vector<std::size_t> first;  // by patch, among the sorted ones; then their number
  std::vector<std::size_t> edits;  // by patch: its place among the edits, if it is whole
  for (std::size_t k = 0; k < sorted.size(); ++k) {
    if (k > 0 && sorted[k].patch == sorted[k - 1].patch) continue;
    const CutPatch* const cut = find_cut(cuts, sorted[k].patch);
    first.push_back(k);
    edits.push_back(out.edits.size());
    if (cut)
      out.edited_cuts.push_back(static_cast<std::uint32_t>(cut - cuts.data()));
    else
      out.edits.emplace_back();
  }
  first.push_back(sorted.size());
  const auto divide_some = [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const std::span<const InsertedVertex> of_patch = std::span(sorted).subspan(first[n], first[n + 1] - first[n]);
      const std::uint32_t patch = of_patch.front().patch;
      CutPatch* const cut = find_cut(cuts, patch);
      const std::uint32_t number = cut ? divide_cut(of_patch, chord(patch), *cut)
                                       : divide_whole(of_patch, divisions[patch], out.edits[edits[n]]);
      for (std::size_t k = first[n]; k < first[n + 1]; ++k)
        out.numbers[order[k]] = number + static_cast<std::uint32_t>(k - first[n]);
    }
  };
  if (Status status = parallel_for(edits.size(), edited_patches_per_task, {.cancel = cancel}, divide_some);
      !status.ok())
    return status;
  return out;
}

}}  // namespace tessera::abi_0_1
