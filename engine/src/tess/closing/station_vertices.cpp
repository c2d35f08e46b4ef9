#include "tess/closing/station_vertices.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include "parallel/parallel_for.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Lists the stations of one edge after the other.
class StationLister {
 public:
  /// `size`: about how many vertices there will be.
  StationLister(const StationRequest& of, std::size_t size, StationBlock& out)
      : of_(of), out_(out), all_(of.set, of.runs, of.divisions, of.cuts, of.stations) {
    out.stations.reserve(size / 2 + 1);
    out.vertices.reserve(size);
    if (of.with_uses) out.uses.reserve(size);
  }

  void add_edge(std::uint32_t id) {
    list_.clear();
    all_.append(id, list_);
    if (list_.segments.empty()) return;
    const PatchEdges::Edge& edge = of_.runs.edges().edges[id];
    const double same = of_.same_share * (edge.range.to - edge.range.from);
    out_.edges.push_back({.edge = id, .first = static_cast<std::uint32_t>(out_.stations.size())});
    list_own();
    find_stations(same, least_same_share * (edge.range.to - edge.range.from));
    visit_segments();
    put(edge, same);
  }
  void add_gaps() {
    list_.clear();
    all_.append_gaps(list_);
    for (const EdgeSegment& segment : list_.segments)
      if (segment.start != segment.end && segment.has_triangle && !is_joined(*segment.run))
        out_.gaps.push_back({list_.low(segment), list_.high(segment), list_.begins(segment)});
  }
  /// Ends the lists. Returns the vertices that were inserted.
  InsertedVertices finish() {
    out_.edges.push_back({.edge = no_id, .first = static_cast<std::uint32_t>(out_.stations.size())});
    out_.stations.push_back({.first = static_cast<std::uint32_t>(out_.vertices.size())});
    out_.same = std::move(all_.same());
    return std::move(all_.inserted());
  }

 private:
  /// A vertex of one use of the edge.
  struct OwnVertex {
    double s;
    std::uint32_t end;  ///< into the list's ends
    std::uint32_t use;  ///< see EdgeRun
  };
  /// Parameters that count as one.
  struct Range {
    double from, to;
    bool changes;  ///< whether an odd number of segments begins or ends here
  };

  /// Lists the vertices of all uses by growing parameters.
  void list_own() {
    own_.clear();
    std::size_t first = 0, uses = 0;  // the first vertex of the use, and the number of uses
    std::uint32_t use = no_id;
    const auto end_use = [&] {
      if (++uses <= 2) merge(first);
      first = own_.size();
    };
    for (const EdgeSegment& segment : list_.segments) {
      if (segment.run->use != use && use != no_id) end_use();
      use = segment.run->use;
      if (own_.size() == first || !is_last(segment.low)) own_.push_back({list_.low(segment).s, segment.low, use});
      own_.push_back({list_.high(segment).s, segment.high, use});
    }
    end_use();
    if (uses > 2) std::ranges::stable_sort(own_, {}, &OwnVertex::s);
  }
  bool is_last(std::uint32_t end) const {
    const SegmentEnd &last = list_.ends[own_.back().end], &next = list_.ends[end];
    return own_.back().end == end || (last.s == next.s && last.vertex == next.vertex);
  }
  /// Merges the vertices from place `middle` on into those before, which are sorted.
  void merge(std::size_t middle) {
    const auto at = own_.begin() + static_cast<std::ptrdiff_t>(middle);
    if (!std::ranges::is_sorted(at, own_.end(), {}, &OwnVertex::s))
      std::ranges::stable_sort(at, own_.end(), {}, &OwnVertex::s);
    if (middle == 0) return;
    merged_.resize(own_.size());
    std::ranges::merge(own_.begin(), at, at, own_.end(), merged_.begin(), {}, &OwnVertex::s, &OwnVertex::s);
    own_.swap(merged_);
  }

  /// Finds the parameters that count as one: those within `same`. Two of one use do only within `least`, so that no
  /// triangle loses its area. Equal parameters always do.
  void find_stations(double same, double least) {
    stations_.clear();
    std::size_t first = 0;  // the first of the station
    for (std::size_t k = 0; k < own_.size(); ++k) {
      const OwnVertex own = own_[k];
      if (k == 0 || own.s - stations_.back().to > same) {
        stations_.push_back({own.s, own.s, false});
        first = k;
        continue;
      }
      const auto is_apart = [&](const OwnVertex& of) { return of.use == own.use && own.s - of.s > least; };
      if (std::any_of(&own_[first], &own_[k], is_apart)) {
        for (first = k; own_[first - 1].s == own.s;) --first;
        stations_.back().to = own_[first - 1].s;
        stations_.push_back({own.s, own.s, false});
      }
      stations_.back().to = own.s;
    }
  }

  /// Whether another patch has triangles on the segments of a run.
  bool is_joined(const EdgeRun& run) const {
    return run.is_side && of_.is_joined[4 * run.patch + static_cast<std::size_t>(run.side)];
  }

  /// Notes the stations where segments begin and end, and inserts vertices at those that lie strictly inside a segment
  /// if the edge has several uses.
  void visit_segments() {
    const bool meet = list_.segments.front().run->use != list_.segments.back().run->use;
    const std::size_t before = own_.size(), last = stations_.size() - 1;
    const EdgeRun* run = nullptr;
    bool is_joined = false;
    std::size_t low = 0;  // the station of the segment's lower end
    StationBlock::Edge& edge = out_.edges.back();
    for (const EdgeSegment& segment : list_.segments) {
      if (segment.run != run) {
        if (run && segment.run->use != run->use) low = 0;
        run = segment.run;
        is_joined = this->is_joined(*run);
      }
      const Interval range{list_.low(segment).s, list_.high(segment).s};
      const bool is_point = segment.start == segment.end;
      while (low < last && stations_[low].to < range.from) ++low;
      std::size_t high = low;
      for (; high < last && stations_[high].to < range.to; ++high)
        if (meet && high > low) insert(segment, range, stations_[high].from, is_point);
      if (is_point) continue;
      stations_[low].changes = !stations_[low].changes;
      stations_[high].changes = !stations_[high].changes;
      if (is_joined || !segment.has_triangle) continue;
      ++edge.alone;
      edge.own += list_.begins(segment);
    }
    if (own_.size() > before) merge(before);
  }
  void insert(const EdgeSegment& segment, const Interval& range, double s, bool is_point) {
    std::uint32_t end = segment.low;
    if (!is_point) {
      end = static_cast<std::uint32_t>(list_.ends.size());
      list_.ends.push_back(all_.insert(segment, range, s));
    }
    own_.push_back({s, end, segment.run->use});
  }

  void put(const PatchEdges::Edge& edge, double same) {
    const std::size_t first_station = out_.stations.size(), count = out_.vertices.size() + own_.size();
    std::size_t next = out_.vertices.size();
    out_.vertices.resize(count);
    if (of_.with_uses) out_.uses.resize(count);
    auto own = own_.begin();
    bool is_odd = false;
    for (const Range& range : stations_) {
      is_odd ^= range.changes;
      const auto first = static_cast<std::uint32_t>(next);
      out_.stations.push_back({range.from, edge.degenerate ? edge.start : no_id, first, is_odd});
      for (; own != own_.end() && own->s <= range.to; ++own, ++next) {
        out_.vertices[next] = list_.ends[own->end].vertex;
        if (of_.with_uses) out_.uses[next] = own->use;
      }
    }
    if (edge.degenerate) return;
    Station &begin = out_.stations[first_station], &end = out_.stations.back();
    if (std::abs(stations_.back().to - edge.range.to) <= same) end.vertex = edge.end;
    if (std::abs(stations_.front().from - edge.range.from) <= same) begin.vertex = edge.start;
  }

  const StationRequest& of_;
  StationBlock& out_;
  EdgeSegments all_;
  SegmentList list_;
  std::vector<OwnVertex> own_, merged_;
  std::vector<Range> stations_;
};

/// About how many vertices the runs of an edge have.
std::size_t size_of_edge(const StationRequest& of, std::size_t edge) {
  constexpr std::size_t of_unknown = 16;
  std::size_t size = 1;
  for (const EdgeRun& run : of.runs.of(edge)) {
    const Division& division = of.divisions[run.patch];
    const std::size_t known = of.stations ? of.stations->count(edge) : 0;
    size += division.empty ? std::max(known, of_unknown)
                           : static_cast<std::size_t>(division.border[static_cast<std::size_t>(run.side)].rate());
  }
  return size;
}

/// Edges that follow each other, and about how many vertices they have.
struct BlockEdges {
  std::uint32_t first, end;
  std::size_t size;
};

/// Returns blocks of edges with about as many vertices.
std::vector<BlockEdges> divide_edges(const StationRequest& of) {
  constexpr std::size_t block_size = 1024;
  const auto edges = static_cast<std::uint32_t>(of.runs.edges().edges.size());
  std::vector<BlockEdges> blocks{{0, 0, 0}};
  for (std::uint32_t edge = 0; edge < edges; ++edge) {
    if (blocks.back().size >= block_size) blocks.push_back({edge, edge, 0});
    blocks.back().end = edge + 1;
    blocks.back().size += size_of_edge(of, edge);
  }
  return blocks;
}

/// Makes one list of the vertices that blocks have inserted. Runs may end at one place of a side in several blocks.
void join_inserted(const std::vector<InsertedVertices>& blocks, StationVertices& out) {
  std::vector<std::uint32_t> firsts, on_sides;
  for (const InsertedVertices& block : blocks) {
    const auto first = static_cast<std::uint32_t>(out.inserted.size());
    firsts.push_back(first);
    for (const std::uint32_t k : block.on_sides) on_sides.push_back(first + k);
    out.inserted.insert(out.inserted.end(), block.all.begin(), block.all.end());
  }
  if (out.inserted.empty()) return;
  std::vector<std::uint32_t> numbers(out.inserted.size());
  std::iota(numbers.begin(), numbers.end(), std::uint32_t{0});
  const auto place = [&](std::uint32_t k) { return out.inserted[k].place(); };
  std::ranges::stable_sort(on_sides, {}, place);
  for (std::size_t k = 1; k < on_sides.size(); ++k)
    if (place(on_sides[k]) == place(on_sides[k - 1])) numbers[on_sides[k]] = numbers[on_sides[k - 1]];
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    if (blocks[k].all.empty()) continue;
    const auto renumber = [&](PatchVertex& of) {
      if (of.vertex & PatchVertex::inserted)
        of.vertex = PatchVertex::inserted | numbers[firsts[k] + (of.vertex ^ PatchVertex::inserted)];
    };
    std::ranges::for_each(out.blocks[k].vertices, renumber);
    for (StationBlock::Gap& gap : out.blocks[k].gaps) renumber(gap.low.vertex), renumber(gap.high.vertex);
  }
}

}  // namespace

Result<StationVertices> station_vertices(const StationRequest& of) {
  const std::vector<BlockEdges> blocks = divide_edges(of);
  StationVertices out;
  out.blocks.resize(blocks.size());
  std::vector<InsertedVertices> inserted(blocks.size());
  std::atomic<bool> was_cancelled = false;  // within a block, which then has no end
  const auto list = [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      StationLister lister(of, blocks[k].size, out.blocks[k]);
      for (std::uint32_t edge = blocks[k].first; edge < blocks[k].end; ++edge) {
        if (of.cancel && of.cancel->load()) {
          was_cancelled = true;
          return;
        }
        lister.add_edge(edge);
      }
      if (k + 1 == blocks.size()) lister.add_gaps();
      inserted[k] = lister.finish();
    }
  };
  if (Status status = parallel_for(blocks.size(), 1, {.cancel = of.cancel}, list); !status.ok()) return status;
  if (was_cancelled) return Status(StatusCode::cancelled, "cancelled by the caller");
  join_inserted(inserted, out);
  for (StationBlock& block : out.blocks) {
    block.first_station = out.station_count;
    out.station_count += block.station_count();
  }
  return out;
}

}}  // namespace tessera::abi_0_1
