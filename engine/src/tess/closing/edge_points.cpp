#include "tess/closing/edge_points.h"

#include <algorithm>
#include <cmath>

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The points of one edge after the other.
class Maker {
 public:
  Maker(const EdgeRuns& runs, EdgeSegments& segments, double same_share, std::span<const std::uint8_t> is_joined)
      : runs_(runs), all_(segments), same_share_(same_share), is_joined_(is_joined) {}

  Result<EdgePoints> run(const std::atomic<bool>* cancel) {
    const std::size_t edges = runs_.edges().edges.size();
    out_.own.resize(edges);
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
  struct Stop {
    double s;
    PatchVertex vertex;
    std::uint32_t use;  ///< see EdgeRun
    friend bool operator==(const Stop&, const Stop&) = default;
  };

  void add_edge(std::uint32_t id) {
    const PatchEdges::Edge& edge = runs_.edges().edges[id];
    const double same = same_share_ * (edge.range.to - edge.range.from);
    stops_.clear();
    for (const EdgeSegment& segment : segments_) {
      const Stop low{segment.from, segment.low, segment.run->use};
      if (stops_.empty() || !(stops_.back() == low)) stops_.push_back(low);
      stops_.push_back({segment.to, segment.high, segment.run->use});
    }
    std::ranges::sort(stops_, {}, &Stop::s);
    find_places(same, least_same_share * (edge.range.to - edge.range.from));
    if (segments_.front().run->use != segments_.back().run->use) insert_missing();
    for (const EdgeSegment& segment : segments_) out_.own[id] += is_alone(segment) && segment.begins();
    put_spans();
    put(id, edge, same);
  }

  /// Finds the parameters that count as one: those within `same`. Two of one use do only within `least`, so that no
  /// triangle loses its area. Equal parameters always do.
  void find_places(double same, double least) {
    places_.clear();
    std::size_t first = 0;  // the first stop of the place
    for (std::size_t k = 0; k < stops_.size(); ++k) {
      const double s = stops_[k].s;
      const auto is_apart = [&](const Stop& of) { return of.use == stops_[k].use && s - of.s > least; };
      const std::span<const Stop> before = std::span(stops_).subspan(first, k - first);
      if (places_.empty() || s - places_.back().to > same) {
        places_.push_back({s, s});
        first = k;
      } else if (std::ranges::any_of(before, is_apart)) {
        for (first = k; stops_[first - 1].s == s;) --first;
        places_.back().to = stops_[first - 1].s;
        places_.push_back({s, s});
      }
      places_.back().to = s;
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
    const auto first = static_cast<std::uint32_t>(out_.points.size());
    const auto point_of = [&](double s) {
      return first +
             static_cast<std::uint32_t>(std::ranges::lower_bound(places_, s, {}, &Interval::to) - places_.begin());
    };
    for (const EdgeSegment& segment : segments_)
      if (segment.start != segment.end)
        out_.spans.push_back({point_of(segment.from), point_of(segment.to), is_alone(segment)});
  }

  /// Inserts vertices at the places that lie strictly inside a segment.
  void insert_missing() {
    const std::size_t before = stops_.size();
    std::uint32_t use = no_id;
    auto after = places_.begin();  // the first place after the segment's lower end
    for (const EdgeSegment& segment : segments_) {
      if (segment.run->use != use) use = segment.run->use, after = places_.begin();
      while (after != places_.end() && after->from <= segment.from) ++after;
      const bool is_point = segment.start == segment.end;
      for (auto at = after; at != places_.end() && at->to < segment.to; ++at)
        stops_.push_back({at->from, is_point ? segment.low : all_.insert(segment, at->from), use});
    }
    if (stops_.size() > before) std::ranges::sort(stops_, {}, &Stop::s);
  }

  void put(std::uint32_t id, const PatchEdges::Edge& edge, double same) {
    auto stop = stops_.begin();
    for (const auto& [from, to] : places_) {
      EdgePoint point{id, no_id, static_cast<std::uint32_t>(out_.vertices.size()), 0};
      for (; stop != stops_.end() && stop->s <= to; ++stop) out_.vertices.push_back(stop->vertex);
      point.count = static_cast<std::uint32_t>(out_.vertices.size()) - point.first;
      if (edge.degenerate || (from == places_.front().from && std::abs(from - edge.range.from) <= same))
        point.vertex = edge.start;
      else if (to == places_.back().to && std::abs(to - edge.range.to) <= same)
        point.vertex = edge.end;
      out_.points.push_back(point);
    }
  }

  const EdgeRuns& runs_;
  EdgeSegments& all_;
  double same_share_;
  std::span<const std::uint8_t> is_joined_;
  EdgePoints out_;
  std::vector<EdgeSegment> segments_;
  std::vector<Stop> stops_;
  std::vector<Interval> places_;  ///< of parameters that count as one
};

}  // namespace

Result<EdgePoints> edge_points(const EdgeRuns& runs, EdgeSegments& segments, double same_share,
                               std::span<const std::uint8_t> is_joined, const std::atomic<bool>* cancel) {
  return Maker(runs, segments, same_share, is_joined).run(cancel);
}

}}  // namespace tessera::abi_0_1
