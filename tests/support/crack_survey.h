#pragma once
// Finds cracks in the certified mesh of a model: open edges that are not borders of the model itself. Takes them from
// tessera::check(), and compares them with the borders of patches that meet another.

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/impl_access.h"
#include "tess/edges/position_bits.h"
#include "tess/plan/plan_facts.h"
#include "tessera/tessellation.h"

namespace tessera::test {

struct CrackCount {
  MeshReport report;
  double bound = 0;
  bool capped = false;          ///< the tolerance takes too many triangles; used the smallest one that does not
  std::size_t own_borders = 0;  ///< borders of the model itself: of patches, which meet no other border
  std::size_t own_edges = 0;    ///< open edges on those, and of patches that loops cut
  std::size_t cracks = 0;       ///< the other open edges
  /// Edges of more than two triangles where patches meet, lie upon each other or are folded: each patch has two of
  /// them.
  std::size_t own_non_manifold = 0;
  std::size_t non_manifold = 0;  ///< the others
  bool folded = false;           ///< a patch lies upon itself: triangles where it turns back have no area
  std::size_t points = 0;        ///< triangles with two corners in one place
  bool trimmed = false;          ///< loops cut it: corners of needles in a plane may round to a line
  bool good() const {
    const bool has_flat = trimmed ? points > 0 : report.degenerate_triangles > 0;
    return cracks == 0 && non_manifold == 0 && (folded || !has_flat) && report.non_finite_vertices == 0;
  }
};

/// The number of borders that meet on each border of a patch, by 4 * patch + side; 0 for a border that is a point.
class [[gnu::visibility("hidden")]] MeetingBorders {
 public:
  MeetingBorders(const PatchSet& set, const WeldRules& weld) : counts_(4 * set.patch_count(), 0) {
    for (std::size_t patch = 0; patch < set.patch_count(); ++patch) is_cut_.push_back(set.is_cut(patch));
    const Result<PlanFacts> facts = find_plan_facts(impl_of(set), {.weld = weld, .angle = {}, .camera = {}}, {});
    if (!facts) return;
    const SharedEdges& edges = facts->borders.edges();
    std::vector<std::uint32_t> borders(edges.count(), 0);
    const auto for_borders = [&](auto visit) {
      for (std::size_t patch = 0; patch < set.patch_count(); ++patch)
        for (std::size_t side = 0; side < 4; ++side) {
          const std::uint32_t edge = edges.edge(patch, all_sides[side]);
          if (edge != no_id && !facts->needs.shapes()[patch].is_curve) visit(4 * patch + side, edge);
        }
    };
    for_borders([&](std::size_t, std::uint32_t edge) { ++borders[edge]; });
    for_borders([&](std::size_t border, std::uint32_t edge) { counts_[border] = borders[edge]; });
  }
  std::uint32_t at(std::size_t border) const { return counts_[border]; }
  bool is_cut(std::size_t patch) const { return is_cut_[patch]; }
  std::size_t lone() const { return static_cast<std::size_t>(std::count(counts_.begin(), counts_.end(), 1u)); }

 private:
  std::vector<std::uint32_t> counts_;
  std::vector<bool> is_cut_;
};

/// The side of its patch that an edge of a mesh lies on, 0 to 3; 4 if inside. A vertex of a border that is a point also
/// lies on the neighbouring sides.
inline std::size_t side_of_edge(const Mesh& mesh, const MeetingBorders& borders, std::size_t patch, std::uint32_t a,
                                std::uint32_t b) {
  const auto is_at = [&](std::uint32_t vertex, std::size_t side) {
    const float u = mesh.parameters[2 * vertex], v = mesh.parameters[2 * vertex + 1];
    return (side % 2 == 0 ? v : u) == (side == 1 || side == 2 ? 1.0f : 0.0f);
  };
  const auto is_on = [&](std::uint32_t vertex, std::size_t side) {
    if (is_at(vertex, side)) return true;
    for (const std::size_t next : {(side + 1) % 4, (side + 3) % 4})
      if (borders.at(4 * patch + next) == 0 && is_at(vertex, next)) return true;
    return false;
  };
  for (std::size_t side = 0; side < 4; ++side)
    if (borders.at(4 * patch + side) > 0 && is_on(a, side) && is_on(b, side)) return side;
  return 4;
}

/// Whether more than two of these triangles of one patch share an edge, by vertices.
inline bool is_branched(std::span<const std::array<std::uint32_t, 3>> uses) {
  std::map<std::array<std::uint32_t, 3>, int> counts;  // patch and both vertices
  return std::any_of(uses.begin(), uses.end(), [&](auto use) {
    if (use[1] > use[2]) std::swap(use[1], use[2]);
    return ++counts[use] > 2;
  });
}

inline void count_edges(const Mesh& mesh, const MeetingBorders& borders, CrackCount& count) {
  struct PlaceHash {
    std::size_t operator()(const PositionBits& bits) const { return hash(bits); }
  };
  std::unordered_map<PositionBits, std::uint32_t, PlaceHash> places;
  std::vector<std::uint32_t> place(mesh.vertex_count());
  for (std::size_t k = 0; k < place.size(); ++k)
    place[k] =
        places.emplace(position_bits(&mesh.positions[3 * k]), static_cast<std::uint32_t>(places.size())).first->second;
  struct Edge {
    std::uint64_t ends;
    std::size_t border;  ///< 4 * patch + side, or none
    std::array<std::uint32_t, 3> use;
    bool operator<(const Edge& other) const { return ends < other.ends; }
  };
  constexpr std::size_t inside = static_cast<std::size_t>(-1);
  std::vector<Edge> edges;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const std::uint32_t* k = &mesh.indices[3 * t];
    if (place[k[0]] == place[k[1]] || place[k[1]] == place[k[2]] || place[k[2]] == place[k[0]]) {
      ++count.points;
      continue;
    }
    for (int c = 0; c < 3; ++c) {
      const std::uint32_t a = k[c], b = k[(c + 1) % 3];
      const std::uint64_t low = std::min(place[a], place[b]), high = std::max(place[a], place[b]);
      const std::size_t side = side_of_edge(mesh, borders, mesh.patches[t], a, b);
      edges.push_back(
          {low << 32 | high, side == 4 ? inside : 4 * std::size_t{mesh.patches[t]} + side, {mesh.patches[t], a, b}});
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t from = 0, to = 0; from < edges.size(); from = to) {
    std::uint32_t meeting = 0;
    for (; to < edges.size() && edges[to].ends == edges[from].ends; ++to)
      if (edges[to].border != inside) meeting = std::max(meeting, borders.at(edges[to].border));
    const bool is_own = meeting == 1 || borders.is_cut(edges[from].use[0]);
    if (to - from == 1) ++(is_own ? count.own_edges : count.cracks);
    if (to - from <= 2) continue;
    std::vector<std::array<std::uint32_t, 3>> uses;
    for (std::size_t k = from; k < to; ++k) uses.push_back(edges[k].use);
    ++(is_branched(uses) ? count.non_manifold : count.own_non_manifold);
  }
}

/// Whether a patch lies upon itself, according to a uniform mesh of it alone.
inline bool is_folded(const PatchSet& set) {
  for (std::size_t k = 0; k < set.patch_count(); ++k) {
    const Result<PatchSet> alone = PatchSet::make(std::span(&set.patch(k), 1));
    const auto plan =
        alone ? Tessellation::make(*alone, {.rates = UniformRates{8, 8}}) : Result<Tessellation>(alone.status());
    Result<Mesh> mesh = plan ? plan->allocate() : Result<Mesh>(plan.status());
    if (!mesh || !plan->run(*alone, mesh->views()).ok()) continue;
    if (const Result<MeshReport> report = check(*mesh); report && report->non_manifold_edges > 0) return true;
  }
  return false;
}

/// The mesh that keeps a share of the model's size; welds borders as it does by default. Errors: those of
/// Tessellation::make.
inline Result<CrackCount> count_cracks(const PatchSet& set, double relative, std::uint64_t max_triangles,
                                       bool fewest = false) {
  const double size = set.box().diagonal();
  TessellationOptions options{
      .tolerance = relative * size, .parameters = VertexParameters::patch, .max_triangles = max_triangles};
  options.fewest = fewest;
  Result<Tessellation> plan = Tessellation::make(set, options);
  CrackCount count;
  if (!plan && plan.status().code() == StatusCode::invalid_argument) {
    options.tolerance.reset();
    options.budget = max_triangles;
    if (Result<Tessellation> finest = Tessellation::make(set, options)) {
      count.capped = true;
      plan = std::move(finest);
    }
  }
  if (!plan) return plan.status();
  Result<Mesh> mesh = plan->allocate();
  if (!mesh) return mesh.status();
  if (const Status status = plan->run(set, mesh->views()); !status.ok()) return status;
  const Result<MeshReport> report = check(*mesh);
  if (!report) return report.status();
  const MeetingBorders borders(set, {count.capped ? 1e-6 * size : relative * size / 8, true});
  count.report = *report;
  count.bound = plan->bound();
  count.own_borders = borders.lone();
  count_edges(*mesh, borders, count);
  count.trimmed = set.cut_count() > 0;
  // Along loops the plan says how many edges are open.
  if (set.cut_count() > 0 && report->open_edges > plan->open_edges()) {
    const std::size_t torn = report->open_edges - plan->open_edges();
    count.cracks += torn;
    count.own_edges -= std::min(torn, count.own_edges);
  }
  count.folded = report->degenerate_triangles > 0 && is_folded(set);
  return count;
}

}  // namespace tessera::test
