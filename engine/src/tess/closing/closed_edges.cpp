#include "tess/closing/closed_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "parallel/parallel_for.h"
#include "tess/bounds/rounded_up.h"
#include "tess/closing/station_places.h"
#include "tess/closing/vertex_inserter.h"
#include "tess/trimmed/patch_points.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

class Closer {
 public:
  explicit Closer(const DividedFaces& faces) : of_(faces), set_(faces.set), runs_(faces.runs) {}

  Result<ClosedEdges> run() {
    Result<StationVertices> met = station_vertices({set_, runs_, of_.divisions, of_.cuts, of_.stations, of_.is_joined,
                                                    of_.same_share, of_.lists_vertices, of_.cancel});
    if (!met) return met.status();
    met_ = *std::move(met);
    numbers_.emplace(of_.divisions, of_.cuts, met_.inserted.size());
    if (Status status = evaluate(); !status.ok()) return status;
    is_open_.assign(set_.edges->edges.size(), 0);
    if (of_.max_gap != std::numeric_limits<double>::infinity()) find_open();
    places_.emplace(set_, runs_, met_, *numbers_, is_open_);
    if (Status status = divide(); !status.ok()) return status;
    list_joined();
    lay_out_members();
    squares_.assign(is_open_.size(), 0);
    if (Status status = for_blocks([&](StationBlock& block) { place_single(block); }); !status.ok()) return status;
    place_joined();
    measure();
    if (of_.lists_vertices)
      if (Status status = list_edge_vertices(); !status.ok()) return status;
    return std::move(out_);
  }

 private:
  /// A vertex of a place that has several stations.
  struct JoinedVertex {
    std::uint32_t place, number;  ///< see BoundaryNumbers
    PatchVertex vertex;
  };

  template <class Visit>
  Status for_blocks(const Visit& visit) {
    const auto visit_some = [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) visit(met_.blocks[k]);
    };
    return parallel_for(met_.blocks.size(), 1, {.cancel = of_.cancel}, visit_some);
  }
  /// Calls visit(Edge, station, its number) for the stations of edges that are closed.
  template <class Visit>
  void for_closed(const StationBlock& block, const Visit& visit) const {
    for (const StationBlock::Edge& edge : block.all_edges())
      for (std::uint32_t k = edge.first; k < (&edge + 1)->first && !is_open_[edge.edge]; ++k)
        visit(edge, block.stations[k], block.first_station + k);
  }
  static std::pair<std::uint32_t, std::uint32_t> vertices_of(const Station& station) {
    return {station.first, (&station + 1)->first};
  }

  /// Finds the faces' own points of all vertices along edges.
  Status evaluate() {
    constexpr std::size_t patches_per_task = 16, inserted_per_task = 256;
    std::vector<std::uint8_t> is_used(numbers_->count(), 0);
    const auto use = [&](const PatchVertex& vertex) { is_used[numbers_->of(vertex)] = 1; };
    for (const StationBlock& block : met_.blocks) {
      for (const PatchVertex& vertex : block.vertices) use(vertex);
      for (const auto& [a, b] : block.same) use(a), use(b);
      for (const StationBlock::Gap& gap : block.gaps) use(gap.low.vertex), use(gap.high.vertex);
    }
    own_.resize(numbers_->count());
    const auto evaluate_some = [&](std::size_t begin, std::size_t end) {
      for (std::size_t patch = begin; patch < end; ++patch) evaluate(static_cast<std::uint32_t>(patch), is_used);
    };
    const auto evaluate_inserted = [&](std::size_t begin, std::size_t end) {
      std::optional<PatchPoints> points;
      for (std::size_t k = begin; k < end; ++k) {
        const InsertedVertex& vertex = met_.inserted[k];
        if (k == begin || vertex.patch != met_.inserted[k - 1].patch)
          points.emplace(set_.patches[vertex.patch], set_.origin);
        own_[numbers_->first(set_.patches.size()) + k] = points->at(vertex.local);
      }
    };
    const Execution quiet{.cancel = of_.cancel};
    if (Status status = parallel_for(set_.patches.size(), patches_per_task, quiet, evaluate_some); !status.ok())
      return status;
    return parallel_for(met_.inserted.size(), inserted_per_task, quiet, evaluate_inserted);
  }
  void evaluate(std::uint32_t patch, std::span<const std::uint8_t> is_used) {
    std::uint32_t number = numbers_->first(patch);
    const std::uint32_t end = numbers_->first(patch + std::size_t{1});
    const auto find_used = [&] {
      number =
          static_cast<std::uint32_t>(std::find(is_used.begin() + number, is_used.begin() + end, 1) - is_used.begin());
    };
    find_used();
    if (number == end) return;
    PatchPoints points(set_.patches[patch], set_.origin);
    const CutPatch* const cut = find_cut(of_.cuts, patch);
    for (; number < end; ++number, find_used()) {
      const std::uint32_t vertex = numbers_->vertex(patch, number);
      if (cut) {
        own_[number] = points.at(cut->vertices[vertex]);
      } else {
        const Division::Parameters at = of_.divisions[patch].parameters(vertex);
        own_[number] = points.at({at.u, at.v});
      }
    }
  }
  const Vec3& own(const PatchVertex& vertex) const { return own_[numbers_->of(vertex)]; }

  /// Finds the edges along which faces are farther apart than the largest gap.
  void find_open() {
    widths_.assign(is_open_.size(), 0);
    for (const StationBlock& block : met_.blocks)
      for (const StationBlock::Edge& edge : block.all_edges()) {
        double& width = widths_[edge.edge];
        for (std::uint32_t k = edge.first; k < (&edge + 1)->first; ++k) {
          Box3 box;
          for (auto [v, end] = vertices_of(block.stations[k]); v < end; ++v) box.extend(own(block.vertices[v]));
          width = std::max(width, box.diagonal());
        }
        is_open_[edge.edge] = width > of_.max_gap;
      }
  }

  /// Gives inserted vertices of edges that are closed their numbers in their patches, and divides triangles.
  Status divide() {
    if (met_.inserted.empty()) return {};
    std::vector<std::uint8_t> is_used(met_.inserted.size(), 0);
    for (const StationBlock& block : met_.blocks)
      for_closed(block, [&](const StationBlock::Edge&, const Station& station, std::uint32_t) {
        for (auto [k, end] = vertices_of(station); k < end; ++k)
          if (const std::uint32_t v = block.vertices[k].vertex; v & PatchVertex::inserted)
            is_used[v ^ PatchVertex::inserted] = 1;
      });
    Result<DividedTriangles> divided =
        divide_triangles(met_.inserted, is_used, of_.divisions, of_.cuts, of_.chord, of_.cancel);
    if (!divided) return divided.status();
    out_.edits = std::move(divided->edits);
    out_.edited_cuts = std::move(divided->edited_cuts);
    resolved_ = std::move(divided->numbers);
    return {};
  }
  /// The number of a vertex in its patch; no_id if it is inserted and not used.
  std::uint32_t in_patch(const PatchVertex& vertex) const {
    return vertex.vertex & PatchVertex::inserted ? resolved_[vertex.vertex ^ PatchVertex::inserted] : vertex.vertex;
  }

  /// Lists the vertices of places that have several stations.
  void list_joined() {
    const auto add = [&](std::uint32_t place, const PatchVertex& vertex) {
      if (place != no_id && in_patch(vertex) != no_id) joined_.push_back({place, numbers_->of(vertex), vertex});
    };
    for (const StationBlock& block : met_.blocks)
      for_closed(block, [&](const StationBlock::Edge&, const Station& station, std::uint32_t id) {
        if (!places_->is_joined(id)) return;
        for (auto [k, end] = vertices_of(station); k < end; ++k) add(places_->of(id), block.vertices[k]);
      });
    const std::span<const PatchVertex> others = places_->others();
    for (std::size_t k = 0; k < others.size(); ++k) add(places_->of_other(k), others[k]);
    sort_joined();
  }
  /// Sorts the vertices by places and numbers, and leaves out those that are there twice.
  void sort_joined() {
    std::vector<std::uint32_t> first(places_->count() + 1, 0);  // by place
    for (const JoinedVertex& vertex : joined_) ++first[vertex.place + 1];
    for (std::size_t k = 1; k < first.size(); ++k) first[k] += first[k - 1];
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    std::vector<JoinedVertex> sorted(joined_.size());
    for (const JoinedVertex& vertex : joined_) sorted[next[vertex.place]++] = vertex;
    joined_.clear();
    for (std::size_t place = 0; place + 1 < first.size(); ++place) {
      const auto of_place = std::span(sorted).subspan(first[place], first[place + 1] - first[place]);
      std::ranges::sort(of_place, {}, &JoinedVertex::number);
      for (std::size_t k = 0; k < of_place.size(); ++k)
        if (k == 0 || of_place[k].number != of_place[k - 1].number) joined_.push_back(of_place[k]);
    }
  }

  /// Counts the vertices of all places.
  void lay_out_members() {
    std::vector<std::uint32_t>& first = out_.first_members;
    first.assign(places_->count() + 1, 0);
    for (const JoinedVertex& vertex : joined_) ++first[vertex.place + 1];
    for (const StationBlock& block : met_.blocks)
      for_closed(block, [&](const StationBlock::Edge&, const Station& station, std::uint32_t id) {
        if (const std::uint32_t place = places_->of(id); place != no_id && !places_->is_joined(id))
          first[place + 1] = (&station + 1)->first - station.first;
      });
    for (std::size_t k = 1; k < first.size(); ++k) first[k] += first[k - 1];
    out_.members.resize(first.back());
    out_.places.resize(places_->count());
  }

  /// Finds the places that are one station.
  void place_single(const StationBlock& block) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>>
        order;  // the number of each vertex, and its place in the block
    for_closed(block, [&](const StationBlock::Edge& edge, const Station& station, std::uint32_t id) {
      const std::uint32_t place = places_->of(id);
      if (place == no_id || places_->is_joined(id)) return;
      order.clear();
      for (auto [k, end] = vertices_of(station); k < end; ++k) order.emplace_back(numbers_->of(block.vertices[k]), k);
      if (order.size() != 2)
        std::ranges::sort(order);
      else if (order[1].first < order[0].first)
        std::swap(order[0], order[1]);
      ClosedEdges::Member* to = &out_.members[out_.first_members[place]];
      Box3 box;
      for (const auto& [number, k] : order) {
        *to++ = {block.vertices[k].patch, in_patch(block.vertices[k])};
        box.extend(own_[number]);
      }
      out_.places[place] = box.centre();
      for (const auto& [number, k] : order) extend_gap(edge.edge, own_[number], place);
    });
  }
  void extend_gap(std::uint32_t edge, const Vec3& at, std::uint32_t place) {
    const Vec3 moved = at - out_.places[place];
    squares_[edge] = std::max(squares_[edge], dot(moved, moved));
  }

  /// Finds the places that have several stations.
  void place_joined() {
    std::vector<std::uint32_t> places;
    std::vector<Box3> boxes;
    std::uint32_t next = 0;  // the next member of the place
    for (const JoinedVertex& vertex : joined_) {
      if (places.empty() || places.back() != vertex.place) {
        places.push_back(vertex.place), boxes.emplace_back();
        next = out_.first_members[vertex.place];
      }
      out_.members[next++] = {vertex.vertex.patch, in_patch(vertex.vertex)};
      boxes.back().extend(own_[vertex.number]);
    }
    for (std::size_t k = 0; k < places.size(); ++k) out_.places[places[k]] = boxes[k].centre();
    put_at_vertices(places, boxes);
    for (const StationBlock& block : met_.blocks)
      for_closed(block, [&](const StationBlock::Edge& edge, const Station& station, std::uint32_t id) {
        if (!places_->is_joined(id) || places_->of(id) == no_id) return;
        for (auto [k, end] = vertices_of(station); k < end; ++k)
          extend_gap(edge.edge, own(block.vertices[k]), places_->of(id));
      });
  }

  /// Moves places to the vertices that the shape states, where the faces' points lie around these. Once edits have
  /// moved the faces away, they do not. `places`: growing.
  void put_at_vertices(std::span<const std::uint32_t> places, std::span<const Box3> boxes) {
    constexpr double slack = 1e-3;  // of the box, which is flat where faces agree
    const std::span<const Vec3> vertices = set_.edges->vertices;
    for (std::uint32_t k = 0; k < vertices.size(); ++k) {
      const std::uint32_t place = places_->of_shape_vertex(k);
      if (place == no_id) continue;
      const Vec3 at = vertices[k] - set_.origin;
      const Box3& own = boxes[static_cast<std::size_t>(std::ranges::lower_bound(places, place) - places.begin())];
      Box3 box = own;
      box.extend(at);
      if (box.diagonal() <= (1 + slack) * own.diagonal()) out_.places[place] = at;
    }
  }

  /// Finds the gaps of all edges, and how many boundary edges of the mesh closing removes.
  void measure() {
    out_.gaps.assign(is_open_.size(), 0);
    for (std::size_t edge = 0; edge < squares_.size(); ++edge) {
      if (squares_[edge] == 0) continue;
      const double gap = std::sqrt(squares_[edge]);
      out_.gap = std::max(out_.gap, gap);
      out_.gaps[edge] = rounded_up(gap);
    }
    for (const StationBlock& block : met_.blocks)
      for (const StationBlock::Edge& edge : block.all_edges()) {
        if (is_open_[edge.edge]) out_.gaps[edge.edge] = rounded_up(widths_[edge.edge] / 2);
        out_.closed_segments += edge.own;
      }
    out_.closed_segments -= count_open();
    for (const StationBlock::Gap& gap : met_.blocks.back().gaps)
      out_.closed_segments += std::int64_t{places_->is_point(gap)} - !gap.begins;
  }

  /// Counts the segments of edges on the boundary of the mesh. The boundary of triangles, modulo 2, stays that of their
  /// images where vertices are joined, so an even number of segments between two places has triangles on all of its
  /// sides, even where those of a sliver have become lines.
  std::int64_t count_open() const {
    std::int64_t open = 0;
    std::vector<std::array<std::uint32_t, 2>>
        odd;  // the places at the ends of segments, of which there is an odd number
    for (const StationBlock& block : met_.blocks) {
      for (const StationBlock::Edge& edge : block.all_edges())
        if (is_open_[edge.edge] || !runs_.meet(edge.edge)) open += edge.alone;  // it gets no vertices
      for_closed(block, [&](const StationBlock::Edge& edge, const Station& station, std::uint32_t id) {
        if (!station.is_odd || !runs_.meet(edge.edge)) return;
        const auto [a, b] = std::minmax({places_->of(id), places_->of(id + 1)});
        if (a != b) odd.push_back({a, b});
      });
    }
    std::ranges::sort(odd);
    for (std::size_t from = 0, to = 0; from < odd.size(); from = to) {
      while (to < odd.size() && odd[to] == odd[from]) ++to;
      open += (to - from) % 2;
    }
    return open;
  }

  Status list_edge_vertices() {
    std::vector<std::vector<EdgeVertex>> of_blocks(met_.blocks.size());
    const auto key = [](const EdgeVertex& of) { return std::tuple(of.use, of.s, of.patch, of.vertex); };
    const auto list = [&](StationBlock& block) {
      std::vector<EdgeVertex>& all = of_blocks[static_cast<std::size_t>(&block - met_.blocks.data())];
      all.reserve(block.vertices.size());
      for (const StationBlock::Edge& edge : block.all_edges()) {
        const std::size_t begin = all.size();
        for (std::uint32_t k = edge.first; k < (&edge + 1)->first; ++k)
          for (auto [v, end] = vertices_of(block.stations[k]); v < end; ++v)
            if (const std::uint32_t vertex = in_patch(block.vertices[v]); vertex != no_id)
              all.push_back({edge.edge, block.uses[v], block.vertices[v].patch, vertex, block.stations[k].s});
        std::ranges::sort(std::span(all).subspan(begin), {}, key);
      }
    };
    if (Status status = for_blocks(list); !status.ok()) return status;
    out_.edge_vertices = std::make_unique<std::vector<EdgeVertex>>();
    std::size_t count = 0;
    for (const std::vector<EdgeVertex>& of : of_blocks) count += of.size();
    out_.edge_vertices->reserve(count);
    for (const std::vector<EdgeVertex>& of : of_blocks)
      out_.edge_vertices->insert(out_.edge_vertices->end(), of.begin(), of.end());
    return {};
  }

  const DividedFaces& of_;
  const PatchSet::Impl& set_;
  const EdgeRuns& runs_;
  StationVertices met_;
  std::vector<Vec3> own_;  ///< by number: points of vertices along edges, relative to the set's origin
  std::vector<std::uint8_t> is_open_;
  std::vector<double> widths_;  ///< by edge, if gaps are limited: the largest distance of the faces' points
  std::optional<BoundaryNumbers> numbers_;
  std::optional<StationPlaces> places_;
  std::vector<std::uint32_t> resolved_;  ///< by inserted vertex: its number in its patch
  std::vector<JoinedVertex> joined_;     ///< by places and numbers
  std::vector<double> squares_;          ///< by edge: the square of the largest distance that a vertex moves
  ClosedEdges out_;
};

}  // namespace

Result<ClosedEdges> close_edges(const DividedFaces& faces) { return Closer(faces).run(); }

}}  // namespace tessera::abi_0_1
