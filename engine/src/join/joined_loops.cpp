#include "join/joined_loops.h"

#include <algorithm>
#include <new>
#include <utility>

#include "join/edge_tables.h"
#include "model/coedge_parameter.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// A curve as it becomes part of a loop.
struct Span {
  Interval range;
  Coedge coedge;
};

/// Throws std::bad_alloc.
Curve part_of(const Curve& curve, const Interval& range) {
  if (range == curve.domain()) return curve;
  const Result<Curve> part = curve.is_rational()
                                 ? Curve::nurbs(curve.degree(), curve.points(), curve.weights(), curve.knots(), range)
                                 : Curve::b_spline(curve.degree(), curve.points(), curve.knots(), range);
  if (!part) throw std::bad_alloc();  // no other error is possible: the range lies within the domain
  return *part;
}

class LoopJoiner {
 public:
  LoopJoiner(const Shape& shape, const FreeCurves& free, std::span<const CurvePiece> pieces,
             std::span<const PieceGroup> groups, UnionFind& vertices, Status& failure)
      : shape_(shape),
        free_(free),
        pieces_(pieces),
        groups_(groups),
        vertices_(vertices),
        failure_(failure),
        out_(shape),
        spans_(free.curves.size()),
        group_of_(pieces.size(), no_id) {
    out_.edges.clear();
  }

  Shape run() {
    keep_edges();
    for (std::uint32_t k = 0; k < groups_.size(); ++k)
      for (const GroupMember& member : groups_[k]) group_of_[member.piece] = k;
    add_free_edges();
    for (const PieceGroup& group : groups_) add_group(group);
    for (std::vector<Span>& spans : spans_)
      std::sort(spans.begin(), spans.end(), [](const Span& a, const Span& b) { return a.range.from < b.range.from; });
    rewrite_loops();
    rewrite_vertices();
    return std::move(out_);
  }

 private:
  const FreeCurve& curve_of(const CurvePiece& piece) const { return free_.curves[piece.curve]; }
  const Coedge& coedge_of(const FreeCurve& curve) const {
    return edge_loops(shape_.faces[curve.use.face])[curve.use.loop].coedges[curve.use.curve];
  }
  std::uint32_t vertex(std::uint32_t k) { return k == no_id ? k : vertices_.find(k).member; }
  std::uint32_t next_edge() const { return static_cast<std::uint32_t>(out_.edges.size()); }

  /// Keeps the edges of no free curve.
  void keep_edges() {
    new_id_.assign(shape_.edges.size(), 0);
    curve_of_edge_.assign(shape_.edges.size(), no_id);
    for (std::uint32_t k = 0; k < free_.curves.size(); ++k) curve_of_edge_[free_.curves[k].edge] = k;
    for (std::uint32_t k = 0; k < shape_.edges.size(); ++k) {
      if (curve_of_edge_[k] != no_id) continue;
      new_id_[k] = next_edge();
      out_.edges.push_back(shape_.edges[k]);
    }
    for (const std::uint32_t k : free_.points) make_point(out_.edges[new_id_[k]]);
  }

  static void make_point(BrepEdge& edge) {
    edge.degenerate = true;
    edge.curve.reset();
  }

  /// Adds an edge for each run of pieces of a curve that are in no group.
  void add_free_edges() {
    for (std::size_t k = 0; k < pieces_.size();) {
      std::size_t next = k + 1;
      if (group_of_[k] != no_id) {
        k = next;
        continue;
      }
      double extent = pieces_[k].extent;
      for (; next < pieces_.size() && pieces_[next].curve == pieces_[k].curve && group_of_[next] == no_id; ++next)
        extent += pieces_[next].extent;
      const CurvePiece &first = pieces_[k], &last = pieces_[next - 1];
      const std::uint32_t id = lead(first, last);
      BrepEdge& edge = out_.edges[id];
      if (vertex(edge.start) == vertex(edge.end) && extent <= free_.distance) make_point(edge);
      k = next;
    }
  }

  /// Adds the edge that the curve from the start of one piece to the end of another leads, and its span.
  std::uint32_t lead(const CurvePiece& first, const CurvePiece& last) {
    const FreeCurve& curve = curve_of(first);
    const Coedge& given = coedge_of(curve);
    const Interval range{first.range.from, last.range.to};
    Coedge coedge{next_edge(), given.reversed, given.parameter};
    BrepEdge edge = shape_.edges[curve.edge];
    const bool whole = range == curve.curve.domain();
    if (!whole) {
      const Interval& all = shape_.edges[curve.edge].range;
      const auto at = [&](double t) {
        return std::clamp(edge_parameter(given, curve.curve.curve(), t), all.from, all.to);
      };
      const double a = at(range.from), b = at(range.to);
      edge.range = {std::min(a, b), std::max(a, b)};
      if (!given.parameter) coedge.parameter = even_parameter(edge.range, range, given.reversed);
    }
    edge.start = curve.nodes[first.node].vertex;
    edge.end = curve.nodes[last.node + 1].vertex;
    if (given.reversed) std::swap(edge.start, edge.end);
    out_.edges.push_back(std::move(edge));
    spans_[first.curve].push_back({range, std::move(coedge)});
    return next_edge() - 1;
  }

  void add_group(const PieceGroup& group) {
    const CurvePiece& leader = pieces_[group.front().piece];
    const std::uint32_t id = lead(leader, leader);
    BrepEdge& edge = out_.edges[id];
    edge.same_parameter = false;
    const Coedge& coedge = coedge_of(curve_of(leader));
    const SpaceCurve leading = on_face(curve_of(leader));
    const auto at = [&](double s) { return leading.at(curve_parameter(coedge, leading.curve(), s)); };
    for (std::size_t k = 1; k < group.size(); ++k) {
      const CurvePiece& piece = pieces_[group[k].piece];
      const SpaceCurve curve = on_face(curve_of(piece));
      edge.tolerance = std::max(edge.tolerance, shape_.edges[curve_of(piece).edge].tolerance);
      const bool turned = group[k].turned != coedge.reversed;
      const LeadingLine line{at, edge.range};
      const FollowingLine follower{&curve, piece.range, turned};
      spans_[piece.curve].push_back(
          {piece.range, {id, turned, following_parameter(line, follower, slack_of(line, follower, leader.extent))}});
    }
  }

  SpaceCurve on_face(const FreeCurve& curve) {
    return free_.line == Line::on_face ? curve.curve : SpaceCurve(shape_, curve.use, Line::on_face, failure_);
  }

  /// How much farther apart than nearest points those at equal parameters may be.
  static double slack_of(const LeadingLine& leader, const FollowingLine& follower, double extent) {
    constexpr double share_of_extent = 1e-8, share_of_distance = 1.0 / 8;
    double distance = 0;
    for (const double x : {0.25, 0.5, 0.75}) {
      const Vec3 p = leader.at((1 - x) * leader.range.from + x * leader.range.to);
      distance = std::max(distance, follower.curve->nearest(p, follower.within).distance);
    }
    return std::max(share_of_extent * extent, share_of_distance * distance);
  }

  void rewrite_loops() {
    for (ShapeFace& face : out_.faces) {
      std::vector<TrimLoop> loops = edge_loops(face);
      for (TrimLoop& loop : loops) {
        if (loop.coedges.empty()) continue;
        TrimLoop made{{}, loop.hole, {}};
        for (std::size_t k = 0; k < loop.curves.size(); ++k) append(loop.curves[k], loop.coedges[k], made);
        loop = std::move(made);
      }
      (face.trims->empty() ? face.outline : face.trims) = std::move(loops);
    }
  }

  void append(const Curve& curve, const Coedge& coedge, TrimLoop& loop) const {
    const std::uint32_t free = curve_of_edge_[coedge.edge];
    if (free == no_id) {
      loop.curves.push_back(curve);
      loop.coedges.push_back({new_id_[coedge.edge], coedge.reversed, coedge.parameter});
      return;
    }
    for (const Span& span : spans_[free]) {
      loop.curves.push_back(part_of(curve, span.range));
      loop.coedges.push_back(span.coedge);
    }
  }

  /// Keeps the vertices in use; those that have become one lie in the middle of their box.
  void rewrite_vertices() {
    std::vector<Box3> boxes(shape_.vertices.size());
    std::vector<double> tolerances(shape_.vertices.size(), 0);
    for (std::uint32_t k = 0; k < shape_.vertices.size(); ++k) {
      const std::uint32_t root = vertex(k);
      boxes[root].extend(shape_.vertices[k].position);
      tolerances[root] = std::max(tolerances[root], shape_.vertices[k].tolerance);
    }
    std::vector<std::uint32_t> ids(shape_.vertices.size(), no_id);
    out_.vertices.clear();
    for (BrepEdge& edge : out_.edges)
      for (std::uint32_t* const end : {&edge.start, &edge.end}) {
        if (*end == no_id) continue;
        const std::uint32_t root = vertex(*end);
        if (ids[root] == no_id) {
          ids[root] = static_cast<std::uint32_t>(out_.vertices.size());
          out_.vertices.push_back({boxes[root].centre(), tolerances[root]});
        }
        *end = ids[root];
      }
  }

  const Shape& shape_;
  const FreeCurves& free_;
  std::span<const CurvePiece> pieces_;
  std::span<const PieceGroup> groups_;
  UnionFind& vertices_;
  Status& failure_;
  Shape out_;
  std::vector<std::vector<Span>> spans_;      ///< of each free curve
  std::vector<std::uint32_t> group_of_;       ///< of each piece
  std::vector<std::uint32_t> new_id_;         ///< of edges that stay
  std::vector<std::uint32_t> curve_of_edge_;  ///< index into FreeCurves::curves
};

}  // namespace

Shape with_joined_loops(const Shape& shape, const FreeCurves& free, std::span<const CurvePiece> pieces,
                        std::span<const PieceGroup> groups, UnionFind& vertices, Status& failure) {
  return LoopJoiner(shape, free, pieces, groups, vertices, failure).run();
}

}}  // namespace tessera::abi_0_1
