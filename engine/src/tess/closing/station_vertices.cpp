#include "tess/closing/station_vertices.h"

#include <algorithm>
#include <cmath>

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The stations of one edge after the other.
class StationLister {
 public:
  StationLister(const EdgeRuns& runs, EdgeSegments& segments, double same_share,
                std::span<const std::uint8_t> is_joined, bool with_uses)
      : runs_(runs), all_(segments), same_share_(same_share), is_joined_(is_joined), with_uses_(with_uses) {}

  Result<StationVertices> run(const std::atomic<bool>* cancel) {
    const std::size_t edges = runs_.edges().edges.size();
    out_.own.resize(edges);
    out_.stations.reserve(4 * edges);
    out_.vertices.reserve(8 * edges);
    out_.spans.reserve(8 * edges);
    if (with_uses_) out_.uses.reserve(8 * edges);
    for (std::uint32_t edge = 0; edge < edges; ++edge) {
      if (cancel && cancel->load()) return Status(StatusCode::cancelled, "cancelled by the caller");
      segments_.clear();
      all_.append(edge, segments_);
      if (!segments_.empty()) add_edge(edge);
    }
    all_.append_gaps(out_.gaps);
    std::erase_if(out_.gaps, [&](const EdgeSegment& gap) { return !is_alone(gap); });
    return std::move(out_);
  }

 private:
  struct OwnVertex {
    double s;
    PatchVertex vertex;
    std::uint32_t use;  ///< see EdgeRun
    friend bool operator==(const OwnVertex&, const OwnVertex&) = default;
  };

  void add_edge(std::uint32_t id) {
    const PatchEdges::Edge& edge = runs_.edges().edges[id];
    const double same = same_share_ * (edge.range.to - edge.range.from);
    own_.clear();
    for (const EdgeSegment& segment : segments_) {
      const OwnVertex low{segment.from, segment.low, segment.run->use};
      if (own_.empty() || !(own_.back() == low)) own_.push_back(low);
      own_.push_back({segment.to, segment.high, segment.run->use});
    }
    std::ranges::sort(own_, {}, &OwnVertex::s);
    find_stations(same, least_same_share * (edge.range.to - edge.range.from));
    if (segments_.front().run->use != segments_.back().run->use) insert_missing();
    for (const EdgeSegment& segment : segments_) out_.own[id] += is_alone(segment) && segment.begins();
    put_spans();
    put(id, edge, same);
  }

  /// Finds the parameters that count as one: those within `same`. Two of one use do only within `least`, so that no
  /// triangle loses its area. Equal parameters always do.
  void find_stations(double same, double least) {
    stations_.clear();
    std::size_t first = 0;  // the first of the station
    for (std::size_t k = 0; k < own_.size(); ++k) {
      const double s = own_[k].s;
      const auto is_apart = [&](const OwnVertex& of) { return of.use == own_[k].use && s - of.s > least; };
      const std::span<const OwnVertex> before = std::span(own_).subspan(first, k - first);
      if (stations_.empty() || s - stations_.back().to > same) {
        stations_.push_back({s, s});
        first = k;
      } else if (std::ranges::any_of(before, is_apart)) {
        for (first = k; own_[first - 1].s == s;) --first;
        stations_.back().to = own_[first - 1].s;
        stations_.push_back({s, s});
      }
      stations_.back().to = s;
    }
  }

  /// Whether another patch has triangles on a segment.
  bool is_joined(const EdgeSegment& segment) const {
    const EdgeRun& run = *segment.run;
    return run.is_side && is_joined_[4 * run.patch + static_cast<std::size_t>(run.side)];
  }
  /// Whether a single triangle has a segment.
  bool is_alone(const EdgeSegment& segment) const {
    return segment.start != segment.end && segment.has_triangle && !is_joined(segment);
  }

  void put_spans() {
    const auto first = static_cast<std::uint32_t>(out_.stations.size());
    const auto station_of = [&](double s) {
      return first +
             static_cast<std::uint32_t>(std::ranges::lower_bound(stations_, s, {}, &Interval::to) - stations_.begin());
    };
    for (const EdgeSegment& segment : segments_)
      if (segment.start != segment.end)
        out_.spans.push_back({station_of(segment.from), station_of(segment.to), is_alone(segment)});
  }

  /// Inserts vertices at the stations that lie strictly inside a segment.
  void insert_missing() {
    const std::size_t before = own_.size();
    std::uint32_t use = no_id;
    auto after = stations_.begin();  // the first station after the segment's lower end
    for (const EdgeSegment& segment : segments_) {
      if (segment.run->use != use) use = segment.run->use, after = stations_.begin();
      while (after != stations_.end() && after->from <= segment.from) ++after;
      const bool is_point = segment.start == segment.end;
      for (auto at = after; at != stations_.end() && at->to < segment.to; ++at)
        own_.push_back({at->from, is_point ? segment.low : all_.insert(segment, at->from), use});
    }
    if (own_.size() > before) std::ranges::sort(own_, {}, &OwnVertex::s);
  }

  void put(std::uint32_t id, const PatchEdges::Edge& edge, double same) {
    auto own = own_.begin();
    for (const auto& [from, to] : stations_) {
      StationVertices::Station station{id, no_id, static_cast<std::uint32_t>(out_.vertices.size()), 0, from};
      for (; own != own_.end() && own->s <= to; ++own) {
        out_.vertices.push_back(own->vertex);
        if (with_uses_) out_.uses.push_back(own->use);
      }
      station.count = static_cast<std::uint32_t>(out_.vertices.size()) - station.first;
      if (edge.degenerate || (from == stations_.front().from && std::abs(from - edge.range.from) <= same))
        station.vertex = edge.start;
      else if (to == stations_.back().to && std::abs(to - edge.range.to) <= same)
        station.vertex = edge.end;
      out_.stations.push_back(station);
    }
  }

  const EdgeRuns& runs_;
  EdgeSegments& all_;
  double same_share_;
  std::span<const std::uint8_t> is_joined_;
  bool with_uses_;
  StationVertices out_;
  std::vector<EdgeSegment> segments_;
  std::vector<OwnVertex> own_;
  std::vector<Interval> stations_;  ///< of parameters that count as one
};

}  // namespace

Result<StationVertices> station_vertices(const EdgeRuns& runs, EdgeSegments& segments, double same_share,
                                         std::span<const std::uint8_t> is_joined, bool with_uses,
                                         const std::atomic<bool>* cancel) {
  return StationLister(runs, segments, same_share, is_joined, with_uses).run(cancel);
}

}}  // namespace tessera::abi_0_1
