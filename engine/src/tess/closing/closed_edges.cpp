#include "tess/closing/closed_edges.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <tuple>

#include "base/union_find.h"
#include "parallel/parallel_for.h"
#include "tess/bounds/rounded_up.h"
#include "tess/closing/station_vertices.h"
#include "tess/trimmed/patch_points.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

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

class Closer {
 public:
  explicit Closer(const DividedFaces& faces)
      : of_(faces),
        set_(faces.set),
        divisions_(faces.divisions),
        cuts_(faces.cuts),
        segments_(faces.set, faces.runs, faces.divisions, faces.cuts, faces.stations),
        runs_(faces.runs) {}

  Result<ClosedEdges> run() {
    Result<StationVertices> met =
        station_vertices(runs_, segments_, of_.same_share, of_.is_joined, of_.lists_vertices, of_.cancel);
    if (!met) return met.status();
    met_ = *std::move(met);
    number_vertices();
    if (Status status = evaluate(); !status.ok()) return status;
    find_open();
    join();
    if (Status status = resolve_inserted(); !status.ok()) return status;
    list_members();
    measure();
    if (of_.lists_vertices) list_edge_vertices();
    return std::move(out_);
  }

 private:
  Status look_at_cancel() const {
    return of_.cancel && of_.cancel->load() ? Status(StatusCode::cancelled, "cancelled by the caller") : Status();
  }

  CutPatch* cut_of(std::uint32_t patch) const { return find_cut(cuts_, patch); }

  /// Gives numbers to all vertices that may lie on edges: those of rings and of cut patches, then inserted ones.
  void number_vertices() {
    bases_.assign(set_.patches.size() + 1, 0);
    for (const PatchEdges::Face& face : set_.edges->faces)
      for (const std::uint32_t patch : face.patches)
        if (patch != no_id) bases_[patch + 1] = boundary_count(patch);
    for (std::size_t k = 1; k < bases_.size(); ++k) bases_[k] += bases_[k - 1];
    zeros_.assign(bases_.begin(), bases_.end());
    for (std::size_t patch = 0; patch < divisions_.size(); ++patch)
      if (!divisions_[patch].empty) zeros_[patch] -= static_cast<std::uint32_t>(divisions_[patch].inner_count());
    count_ = bases_.back() + static_cast<std::uint32_t>(segments_.inserted().size());
    is_used_.assign(count_, 0);
    of_stations_.reserve(met_.vertices.size());
    const auto use = [&](const PatchVertex& vertex) {
      const std::uint32_t number = this->number(vertex);
      is_used_[number] = 1;
      return number;
    };
    for (const PatchVertex& vertex : met_.vertices) of_stations_.push_back(use(vertex));
    for (const auto& [a, b] : segments_.same()) same_.push_back({use(a), use(b)});
    for (const EdgeSegment& gap : met_.gaps) gaps_.push_back({use(gap.low), use(gap.high)});
  }
  std::uint32_t boundary_count(std::uint32_t patch) const {
    if (const CutPatch* const cut = cut_of(patch)) return static_cast<std::uint32_t>(cut->vertices.size());
    return divisions_[patch].empty ? 0 : static_cast<std::uint32_t>(divisions_[patch].ring_count());
  }
  std::uint32_t number(const PatchVertex& vertex) const {
    return vertex.vertex & PatchVertex::inserted ? bases_.back() + (vertex.vertex ^ PatchVertex::inserted)
                                                 : zeros_[vertex.patch] + vertex.vertex;
  }

  /// Finds the faces' own points of all vertices.
  Status evaluate() {
    own_.resize(count_);
    constexpr std::size_t patches_per_task = 4;
    const auto evaluate_some = [&](std::size_t begin, std::size_t end) {
      for (std::size_t patch = begin; patch < end; ++patch) evaluate(static_cast<std::uint32_t>(patch));
    };
    const Execution quiet{.cancel = of_.cancel};
    if (Status status = parallel_for(bases_.size() - 1, patches_per_task, quiet, evaluate_some); !status.ok())
      return status;
    const std::span<const InsertedVertex> inserted = segments_.inserted();
    std::optional<PatchPoints> points;
    for (std::size_t k = 0; k < inserted.size(); ++k) {
      if (k == 0 || inserted[k].patch != inserted[k - 1].patch)
        points.emplace(set_.patches[inserted[k].patch], set_.origin);
      own_[bases_.back() + k] = points->at(inserted[k].local);
    }
    return {};
  }
  void evaluate(std::uint32_t patch) {
    const std::uint32_t begin = bases_[patch], end = bases_[patch + 1];
    if (std::find(is_used_.begin() + begin, is_used_.begin() + end, 1) == is_used_.begin() + end) return;
    PatchPoints points(set_.patches[patch], set_.origin);
    const CutPatch* const cut = cut_of(patch);
    for (std::uint32_t k = begin; k < end; ++k) {
      if (!is_used_[k]) continue;
      if (cut) {
        own_[k] = points.at(cut->vertices[k - begin]);
      } else {
        const Division::Parameters at = divisions_[patch].parameters(k - zeros_[patch]);
        own_[k] = points.at({at.u, at.v});
      }
    }
  }

  /// Finds the edges along which faces are farther apart than the largest gap.
  void find_open() {
    is_open_.assign(set_.edges->edges.size(), 0);
    widths_.assign(is_open_.size(), 0);
    if (of_.max_gap == std::numeric_limits<double>::infinity()) return;
    for (const StationVertices::Station& station : met_.stations) {
      Box3 box;
      for (std::uint32_t k = 0; k < station.count; ++k) box.extend(own_[of_stations_[station.first + k]]);
      const double width = box.diagonal();
      if (width > of_.max_gap) is_open_[station.edge] = 1;
      widths_[station.edge] = std::max(widths_[station.edge], width);
    }
  }

  void join() {
    sets_.emplace(count_ + set_.edges->vertices.size());
    for (const auto& [a, b] : same_) sets_->unite(a, b);
    for (const StationVertices::Station& station : met_.stations) {
      if (is_open_[station.edge]) continue;
      const std::uint32_t* const of = &of_stations_[station.first];
      for (std::uint32_t k = 1; k < station.count; ++k) sets_->unite(of[0], of[k]);
      if (station.vertex != no_id) sets_->unite(of[0], count_ + station.vertex);
    }
    join_gaps();
  }

  /// Makes a point of each line that closes a gap, if both of its ends are one place: its other vertices are there too.
  void join_gaps() {
    if (gaps_.empty()) return;
    std::vector<std::uint32_t> places(count_, no_id);  // by vertex of a station: its place
    for (const StationVertices::Station& station : met_.stations)
      for (std::uint32_t k = 0; k < station.count && !is_open_[station.edge]; ++k)
        places[of_stations_[station.first + k]] = sets_->find(of_stations_[station.first + k]).member;
    UnionFind lines(count_);
    for (const auto& [a, b] : same_) lines.unite(a, b);
    for (const auto& [a, b] : gaps_) lines.unite(a, b);
    std::vector<std::uint32_t> ends(count_, no_id);  // by line: the place of its ends
    std::vector<std::uint8_t> is_apart(count_, 0);
    for (const auto& gap : gaps_) {
      const std::uint32_t line = lines.find(gap[0]).member;
      for (const std::uint32_t end : gap) {
        if (places[end] == no_id) continue;
        is_apart[line] |= ends[line] != no_id && ends[line] != places[end];
        ends[line] = places[end];
      }
    }
    for (const auto& gap : gaps_) {
      const std::uint32_t line = lines.find(gap[0]).member;
      for (const std::uint32_t end : gap)
        if (ends[line] != no_id && !is_apart[line]) sets_->unite(end, ends[line]);
    }
  }

  /// Gives inserted vertices of edges that are closed their numbers in their patches, and divides triangles.
  Status resolve_inserted() {
    std::vector<InsertedVertex> inserted(segments_.inserted().begin(), segments_.inserted().end());
    std::vector<std::uint32_t> order;
    std::vector<std::uint8_t> is_used(inserted.size(), 0);
    for (const StationVertices::Station& station : met_.stations)
      for (std::uint32_t k = 0; k < station.count && !is_open_[station.edge]; ++k)
        if (const std::uint32_t v = met_.vertices[station.first + k].vertex; v & PatchVertex::inserted)
          is_used[v ^ PatchVertex::inserted] = 1;
    for (std::uint32_t k = 0; k < inserted.size(); ++k)
      if (is_used[k]) order.push_back(k);
    std::ranges::sort(order, {}, [&](std::uint32_t k) {
      const InsertedVertex& v = inserted[k];
      return std::tuple(v.patch, v.start, v.end, v.at, k);
    });
    resolved_.assign(inserted.size(), no_id);
    std::vector<InsertedVertex> of_patch;
    for (std::size_t begin = 0; begin < order.size();) {
      if (Status status = look_at_cancel(); !status.ok()) return status;
      const std::uint32_t patch = inserted[order[begin]].patch;
      of_patch.clear();
      std::size_t end = begin;
      for (; end < order.size() && inserted[order[end]].patch == patch; ++end) of_patch.push_back(inserted[order[end]]);
      const std::uint32_t first = edit(patch, of_patch);
      for (std::size_t k = begin; k < end; ++k) resolved_[order[k]] = first + static_cast<std::uint32_t>(k - begin);
      begin = end;
    }
    return {};
  }

  /// Divides the triangles of a patch. Returns the number of the first new vertex.
  std::uint32_t edit(std::uint32_t patch, std::span<const InsertedVertex> inserted) {
    if (CutPatch* const cut = cut_of(patch)) {
      const auto first = static_cast<std::uint32_t>(cut->vertices.size());
      for (const InsertedVertex& vertex : inserted) cut->vertices.push_back(vertex.local);
      const std::size_t count = cut->triangles.size();
      const ChordBound chord = of_.chord(patch);
      // A chord's sliver, and that of its parts beside it, unless these lie within.
      if (std::ranges::any_of(inserted, &InsertedVertex::widens_sliver)) cut->sliver *= 2;
      const auto itself = [](std::uint32_t vertex) { return vertex; };  // cut patches have one vertex at a pole
      for (const std::uint32_t k : insert_vertices(inserted, first, itself, cut->triangles))
        cut->measure(cut->triangles[k], chord);
      for (std::size_t k = count; k < cut->triangles.size(); ++k) cut->measure(cut->triangles[k], chord);
      out_.edited_cuts.push_back(static_cast<std::uint32_t>(cut - cuts_.data()));
      return first;
    }
    const Division& division = divisions_[patch];
    const auto first = static_cast<std::uint32_t>(division.vertex_count());
    const std::size_t count = division.triangle_count() - 2 * division.cell_count();  // cells are not on borders
    std::vector<CutPatch::Triangle> triangles(count);
    division.write_triangles(0, triangles.data()->data(), false);
    PatchEdit& edit = out_.edits.emplace_back();
    edit.patch = patch;
    for (const InsertedVertex& vertex : inserted) edit.vertices.push_back(vertex.local);
    const auto pole = [&](std::uint32_t vertex) { return first_at_pole(division, vertex); };
    for (const std::uint32_t k : insert_vertices(inserted, first, pole, triangles))
      edit.changed.emplace_back(k, triangles[k]);
    edit.added.assign(triangles.begin() + static_cast<std::ptrdiff_t>(count), triangles.end());
    return first;
  }

  void list_members() {
    // Vertices where no faces meet stay: they may be welded. A place gets the number of its root first.
    std::vector<std::uint32_t>& first = out_.first_members;
    first.assign(1, 0);
    places_.assign(count_ + set_.edges->vertices.size(), no_id);
    for (const StationVertices::Station& station : met_.stations) {
      if (is_open_[station.edge] || !runs_.meet(station.edge)) continue;
      std::uint32_t& place = places_[sets_->find(of_stations_[station.first]).member];
      if (place == no_id) place = static_cast<std::uint32_t>(first.size() - 1), first.push_back(0);
    }
    for (std::uint32_t k = 0; k < count_; ++k) {
      if (!is_used_[k] || (k >= bases_.back() && resolved_[k - bases_.back()] == no_id)) continue;
      places_[k] = places_[sets_->find(k).member];
      if (places_[k] != no_id) ++first[places_[k] + 1];
    }
    for (std::size_t k = 1; k < first.size(); ++k) first[k] += first[k - 1];
    out_.members.resize(first.back());
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    const auto put = [&](std::uint32_t k, std::uint32_t patch, std::uint32_t vertex) {
      if (places_[k] != no_id) out_.members[next[places_[k]]++] = {patch, vertex};
    };
    for (std::uint32_t patch = 0; patch + 1 < bases_.size(); ++patch)
      for (std::uint32_t k = bases_[patch]; k < bases_[patch + 1]; ++k) put(k, patch, k - zeros_[patch]);
    const std::span<const InsertedVertex> inserted = segments_.inserted();
    for (std::uint32_t k = 0; k < inserted.size(); ++k)
      if (resolved_[k] != no_id) put(bases_.back() + k, inserted[k].patch, resolved_[k]);
  }

  void measure() {
    std::vector<Box3> boxes(out_.first_members.size() - 1);
    for (std::uint32_t k = 0; k < count_; ++k)
      if (const std::uint32_t place = places_[k]; place != no_id) boxes[place].extend(own_[k]);
    out_.places.reserve(boxes.size());
    for (const Box3& box : boxes) out_.places.push_back(box.centre());
    put_at_vertices(boxes);
    out_.gaps.assign(set_.edges->edges.size(), 0);
    for (const StationVertices::Station& station : met_.stations) {
      if (is_open_[station.edge]) continue;
      double gap = 0;
      for (const std::uint32_t vertex : std::span(of_stations_).subspan(station.first, station.count))
        if (places_[vertex] != no_id) gap = std::max(gap, length(own_[vertex] - out_.places[places_[vertex]]));
      out_.gap = std::max(out_.gap, gap);
      out_.gaps[station.edge] = std::max(out_.gaps[station.edge], rounded_up(gap));
    }
    for (std::size_t edge = 0; edge < is_open_.size(); ++edge)
      if (is_open_[edge]) out_.gaps[edge] = rounded_up(widths_[edge] / 2);
    for (const std::uint32_t own : met_.own) out_.closed_segments += own;
    out_.closed_segments -= count_open();
    for (std::size_t k = 0; k < gaps_.size(); ++k) {
      const std::uint32_t low = places_[gaps_[k][0]], high = places_[gaps_[k][1]];
      out_.closed_segments += std::int64_t{low == high && low != no_id} - !met_.gaps[k].begins();
    }
  }

  /// Moves places to the vertices that the shape states, where the faces' points lie around these. Once edits have
  /// moved the faces away, they do not.
  void put_at_vertices(std::span<const Box3> boxes) {
    constexpr double slack = 1e-3;  // of the box, which is flat where faces agree
    const std::span<const Vec3> vertices = set_.edges->vertices;
    for (std::uint32_t k = 0; k < vertices.size(); ++k) {
      const std::uint32_t member = sets_->find(count_ + k).member;
      const std::uint32_t place = member < count_ ? places_[member] : no_id;
      if (place == no_id) continue;
      const Vec3 at = vertices[k] - set_.origin;
      Box3 box = boxes[place];
      box.extend(at);
      if (box.diagonal() <= (1 + slack) * boxes[place].diagonal()) out_.places[place] = at;
    }
  }

  void list_edge_vertices() {
    out_.edge_vertices = std::make_unique<std::vector<EdgeVertex>>();
    std::vector<EdgeVertex>& all = *out_.edge_vertices;
    all.reserve(met_.vertices.size());
    std::size_t begin = 0;  // of the edge
    const auto sort_edge = [&] {
      std::ranges::sort(std::span(all).subspan(begin), {},
                        [](const EdgeVertex& of) { return std::tuple(of.use, of.s, of.patch, of.vertex); });
      begin = all.size();
    };
    for (const StationVertices::Station& station : met_.stations) {
      if (!all.empty() && all.back().edge != station.edge) sort_edge();
      for (std::uint32_t k = station.first; k < station.first + station.count; ++k) {
        const auto [patch, own] = met_.vertices[k];
        const bool is_inserted = (own & PatchVertex::inserted) != 0;
        const std::uint32_t vertex = is_inserted ? resolved_[own ^ PatchVertex::inserted] : own;
        if (vertex != no_id) all.push_back({station.edge, met_.uses[k], patch, vertex, station.s});
      }
    }
    sort_edge();
  }

  /// Counts the segments of edges on the boundary of the mesh. The boundary of triangles, modulo 2, stays that of their
  /// images where vertices are joined, so an even number of segments between two places has triangles on all of its
  /// sides, even where those of a sliver have become lines.
  std::int64_t count_open() {
    std::int64_t open = 0;
    std::vector<std::array<std::uint32_t, 2>> segments;
    segments.reserve(met_.spans.size());
    for (const auto& [low, high, is_alone] : met_.spans) {
      const std::uint32_t edge = met_.stations[low].edge;
      if (is_open_[edge] || !runs_.meet(edge)) {
        open += is_alone;  // it gets no vertices
        continue;
      }
      for (std::uint32_t k = low; k < high; ++k) {
        const std::uint32_t a = sets_->find(of_stations_[met_.stations[k].first]).member;
        const std::uint32_t b = sets_->find(of_stations_[met_.stations[k + 1].first]).member;
        if (a != b) segments.push_back({std::min(a, b), std::max(a, b)});
      }
    }
    std::ranges::sort(segments);
    for (std::size_t from = 0, to = 0; from < segments.size(); from = to) {
      while (to < segments.size() && segments[to] == segments[from]) ++to;
      open += (to - from) % 2;
    }
    return open;
  }

  const DividedFaces& of_;
  const PatchSet::Impl& set_;
  std::span<const Division> divisions_;
  std::span<CutPatch> cuts_;
  EdgeSegments segments_;
  const EdgeRuns& runs_;
  StationVertices met_;
  std::vector<std::uint32_t> bases_;  ///< by patch: the number of its first vertex; then that of the first inserted one
  std::vector<std::uint32_t> zeros_;  ///< by patch: the number that its vertex 0 would have, modulo 2^32
  std::uint32_t count_ = 0;
  std::vector<std::uint8_t> is_used_;
  std::vector<std::uint32_t> of_stations_;
  std::vector<std::array<std::uint32_t, 2>> same_, gaps_;  ///< vertices; of lines that close gaps: their segments
  std::vector<Vec3> own_;
  std::vector<std::uint8_t> is_open_;
  std::vector<double> widths_;  ///< by edge: the largest distance of the faces' points
  std::optional<UnionFind> sets_;
  std::vector<std::uint32_t> resolved_, places_;
  ClosedEdges out_;
};

}  // namespace

Result<ClosedEdges> close_edges(const DividedFaces& faces) { return Closer(faces).run(); }

}}  // namespace tessera::abi_0_1
