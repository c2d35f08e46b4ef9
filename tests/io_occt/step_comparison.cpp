#include "io_occt/step_comparison.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <variant>

#include "support/synthetic_sets.h"
#include "tessera/edge_matching.h"
#include "tessera/measures.h"
#include "tessera/mesh.h"
#include "tessera/patch_set.h"
#include "tessera/tessellation.h"
#include "tessera/topology.h"

namespace tessera::test {
namespace {

constexpr double relative_tolerance = 1e-3;

std::string words(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

std::string both(double ours, double theirs) { return words(ours) + ", OpenCASCADE's " + words(theirs); }

/// The measures of one shape.
struct ShapeFacts {
  std::vector<SurfaceMeasures> faces;
  std::vector<double> slack;  ///< of each face, the area beside its edges that their gaps leave open
  std::vector<Measured> volumes;
  std::vector<bool> closed;
  std::size_t edges = 0;  ///< that are no points and no seams
  double gap = 0, size = 0;
  std::optional<std::size_t> open_edges;  ///< of its mesh; none if it cannot be made
};

/// A parameter that a loop states beyond the seam of a closed surface, within the surface's domain.
double wrapped(double x, double from, double to) {
  const double period = to - from, slack = 1e-6 * period;
  return x < from - slack ? x + period : x > to + slack ? x - period : x;
}

/// The largest distance of a face from an edge that it uses, at equal parameters.
double distance_from_edge(const ShapeFace& face, const TrimLoop& loop, std::size_t curve, const BrepEdge& edge) {
  const Coedge& coedge = loop.coedges[curve];
  const Curve& trim = loop.curves[curve];
  const Domain& domain = std::get<BSplineSurface>(face.surface).domain();
  double largest = 0;
  for (int k = 0; k <= 64; ++k) {
    const double s = edge.range.from + (edge.range.to - edge.range.from) * k / 64;
    const double t = coedge.parameter  ? position(*coedge.parameter, s).x
                     : coedge.reversed ? trim.domain().from + trim.domain().to - s
                                       : s;
    const Vec3 at = position(trim, t);
    const Result<SurfaceJet> jet =
        evaluate_jet(face.surface, wrapped(at.x, domain.u0, domain.u1), wrapped(at.y, domain.v0, domain.v1));
    if (jet) largest = std::max(largest, length(jet->position - position(*edge.curve, s)));
  }
  return largest;
}

double length_of(const Curve& curve, const Interval& range) {
  double sum = 0;
  Vec3 last = position(curve, range.from);
  for (int k = 1; k <= 16; ++k) {
    const Vec3 next = position(curve, range.from + (range.to - range.from) * k / 16);
    sum += length(next - last);
    last = next;
  }
  return sum;
}

/// Whether both ends of a direction of a surface are one line.
bool is_closed(const BSplineSurface& surface, bool along_u) {
  const Domain& d = surface.domain();
  double gap = 0, size = 0;
  for (int k = 0; k <= 8; ++k) {
    const double x = along_u ? d.v_at(k / 8.0) : d.u_at(k / 8.0);
    const Vec3 a = evaluate_jet(surface, along_u ? d.u0 : x, along_u ? x : d.v0).position;
    const Vec3 b = evaluate_jet(surface, along_u ? d.u1 : x, along_u ? x : d.v1).position;
    const Vec3 middle = evaluate_jet(surface, d.u_at(0.4), d.v_at(k / 8.0)).position;
    gap = std::max(gap, length(a - b)), size = std::max(size, length(a - middle));
  }
  return gap <= 1e-6 * size;
}

/// Whether one face uses an edge twice.
bool is_seam(std::span<const EdgeUse> uses) { return uses.size() == 2 && uses[0].face == uses[1].face; }

/// The distances of an edge's vertices from the ends of its curve, together.
double distance_from_vertices(const Shape& shape, const BrepEdge& edge) {
  double sum = 0;
  for (const auto& [vertex, s] : {std::pair(edge.start, edge.range.from), std::pair(edge.end, edge.range.to)})
    if (vertex != no_id) sum += length(shape.vertices[vertex].position - position(*edge.curve, s));
  return sum;
}

/// The area that lies between a face's loops and the edges and vertices that they stand for. Corners that do not meet
/// move each edge beside them.
double slack_of(const Shape& shape, const ShapeFace& face) {
  double beside = 0, longest = 0, corners = 0;
  for (const TrimLoop& loop : edge_loops(face))
    for (std::size_t k = 0; k < loop.coedges.size(); ++k) {
      const BrepEdge& edge = shape.edges[loop.coedges[k].edge];
      if (edge.degenerate || !edge.curve) continue;
      const double along = length_of(*edge.curve, edge.range);
      beside += along * distance_from_edge(face, loop, k, edge);
      longest = std::max(longest, along);
      corners += distance_from_vertices(shape, edge);
    }
  return beside + longest * corners;
}

/// How far a face's loops leave its rectangle, in length; not along directions in which it is closed.
double excess_of(const ShapeFace& face) {
  const auto& surface = std::get<BSplineSurface>(face.surface);
  const Domain& d = surface.domain();
  const bool closed_u = is_closed(surface, true), closed_v = is_closed(surface, false);
  double u = 0, v = 0;
  for (const TrimLoop& loop : edge_loops(face))
    for (const Curve& curve : loop.curves)
      for (int k = 0; k <= 512; ++k) {
        const Vec3 p = position(curve, curve.domain().from + (curve.domain().to - curve.domain().from) * k / 512);
        if (!closed_u) u = std::max({u, d.u0 - p.x, p.x - d.u1});
        if (!closed_v) v = std::max({v, d.v0 - p.y, p.y - d.v1});
      }
  const SurfaceJet middle = evaluate_jet(surface, d.u_at(0.5), d.v_at(0.5));
  return std::max(u * length(middle.du), v * length(middle.dv));
}

/// The largest distance of a face's loops from their edges.
double deviation_of(const Shape& shape, const ShapeFace& face) {
  double largest = 0;
  for (const TrimLoop& loop : edge_loops(face))
    for (std::size_t k = 0; k < loop.coedges.size(); ++k) {
      const BrepEdge& edge = shape.edges[loop.coedges[k].edge];
      if (!edge.degenerate && edge.curve) largest = std::max(largest, distance_from_edge(face, loop, k, edge));
    }
  return largest;
}

std::optional<std::size_t> open_edges_of(const Shape& stated, double tolerance) {
  const EdgeUses uses = value_of(edge_uses(stated));
  bool is_free = false;
  for (std::size_t k = 0; k < stated.edges.size(); ++k) is_free |= uses[k].size() == 1 && !stated.edges[k].degenerate;
  const Result<double> distance = is_free ? joining_distance(stated) : Result<double>(0.0);
  const bool joins = distance && *distance > 0;
  const Result<Shape> joined = joins ? joined_edges(stated, *distance) : Result<Shape>(stated);
  const Result<PatchSet> set = make_patch_set(joined ? *joined : stated);
  if (!set || !(tolerance > 0)) return {};
  const Result<Tessellation> plan = Tessellation::make(*set, {.tolerance = tolerance});
  if (!plan) return {};
  Mesh mesh = value_of(plan->allocate());
  if (!plan->run(*set, mesh.views()).ok()) return {};
  return value_of(check(mesh)).open_edges;
}

ShapeFacts facts_of(const Shape& shape) {
  ShapeFacts facts;
  Model alone;
  alone.shapes = {shape};
  alone.instances.emplace_back();
  alone.surfaces = value_of(placed_faces(alone.shapes, alone.instances));
  if (const Result<AreaMeasures> areas = measure_surfaces(alone, {.accuracy = 1e-8})) facts.faces = areas->surfaces;
  for (const ShapeFace& face : shape.faces) facts.slack.push_back(slack_of(shape, face));
  if (const auto solids = measure_solids(shape, {.accuracy = 1e-8}))
    for (const BodyMeasures& body : *solids) facts.volumes.push_back(body.volume);
  facts.closed = value_of(closed_shells(shape));
  const EdgeUses uses = value_of(edge_uses(shape));
  for (std::size_t k = 0; k < shape.edges.size(); ++k) facts.edges += !shape.edges[k].degenerate && !is_seam(uses[k]);
  if (const Result<std::vector<double>> gaps = edge_gaps(shape, 33); gaps && !gaps->empty())
    facts.gap = *std::ranges::max_element(*gaps);
  if (const Result<MeasuredBox> box = measure_box(alone, {.accuracy = 1e-3})) facts.size = box->box.diagonal();
  facts.open_edges = open_edges_of(shape, relative_tolerance * facts.size);
  return facts;
}

/// How unlike two faces are: the distance of their centroids as a share of the size, and a little of their areas'.
double unlikeness(const ShapeFacts& ours, std::size_t face, const ShapeFacts& theirs, std::size_t other) {
  const SurfaceMeasures &a = ours.faces[face], &b = theirs.faces[other];
  return 1e-3 * std::abs(a.area.value - b.area.value) / std::max(a.area.value, 1e-300) +
         length(a.centroid.value - b.centroid.value) / std::max(ours.size, 1e-300);
}

/// For each face of ours, theirs: the one in the same place of the list if it is alike, else the most alike of those
/// left; the number of theirs where none is left.
std::vector<std::size_t> matched_faces(const ShapeFacts& ours, const ShapeFacts& theirs) {
  std::vector<std::size_t> match(ours.faces.size(), theirs.faces.size());
  std::vector<bool> is_taken(theirs.faces.size());
  const bool same_number = match.size() == is_taken.size();
  for (std::size_t k = 0; k < std::min(match.size(), is_taken.size()); ++k)
    if (unlikeness(ours, k, theirs, k) <= (same_number ? 1e-6 : 1e-9)) match[k] = k, is_taken[k] = true;
  for (std::size_t k = 0; k < match.size(); ++k) {
    if (match[k] < is_taken.size()) continue;
    for (std::size_t other = 0; other < is_taken.size(); ++other)
      if (!is_taken[other] &&
          (match[k] == is_taken.size() || unlikeness(ours, k, theirs, other) < unlikeness(ours, k, theirs, match[k])))
        match[k] = other;
    if (match[k] < is_taken.size()) is_taken[match[k]] = true;
  }
  return match;
}

class Comparison {
 public:
  Comparison(const Model& ours, const Model& theirs) : ours_(ours), theirs_(theirs) {}

  StepComparison run() {
    count();
    if (ours_.shapes.size() != theirs_.shapes.size()) return std::move(out_);
    for (std::size_t k = 0; k < ours_.shapes.size(); ++k) {
      facts_.push_back(facts_of(ours_.shapes[k]));
      peers_.push_back(facts_of(theirs_.shapes[k]));
      matches_.push_back(matched_faces(facts_.back(), peers_.back()));
      compare_shape(k);
    }
    if (ours_.instances.size() != theirs_.instances.size()) return std::move(out_);
    for (std::size_t k = 0; k < ours_.instances.size(); ++k) compare_instance(k);
    return std::move(out_);
  }

 private:
  void count() {
    const auto differ = [&](const char* kind, std::size_t ours, std::size_t theirs) {
      if (ours != theirs) out_.add(kind, both(static_cast<double>(ours), static_cast<double>(theirs)));
    };
    out_.shapes = ours_.shapes.size(), out_.instances = ours_.instances.size();
    differ("shapes", ours_.shapes.size(), theirs_.shapes.size());
    differ("instances", ours_.instances.size(), theirs_.instances.size());
    differ("warnings", ours_.warnings.size(), theirs_.warnings.size());
    if (ours_.file_unit != theirs_.file_unit) out_.add("unit", ours_.file_unit + ", " + theirs_.file_unit);
  }

  void compare_shape(std::size_t k) {
    const Shape &ours = ours_.shapes[k], &theirs = theirs_.shapes[k];
    const ShapeFacts &facts = facts_[k], &peers = peers_[k];
    const std::string where = "shape " + std::to_string(k) + ": ";
    out_.faces += ours.faces.size(), out_.edges += facts.edges, out_.solids += ours.solid_count;
    if (*ours.name != *theirs.name) out_.add("names", where + *ours.name + ", " + *theirs.name);
    const auto differ = [&](const char* kind, std::size_t mine, std::size_t peer) {
      if (mine != peer) out_.add(kind, where + both(static_cast<double>(mine), static_cast<double>(peer)));
    };
    differ("faces", ours.faces.size(), theirs.faces.size());
    differ("edges", facts.edges, peers.edges);
    differ("solids", ours.solid_count, theirs.solid_count);
    for (std::size_t face = 0; face < ours.faces.size(); ++face)
      if (const double excess = excess_of(ours.faces[face]);
          excess > 1e-7 * facts.size + deviation_of(ours, ours.faces[face]))
        out_.add("rectangle", where + "face " + std::to_string(face) + ": a loop is " + words(excess) + " outside");
    compare_faces(k, where);
    compare_volumes(facts, peers, where);
    const auto closed = [](const ShapeFacts& one) { return std::ranges::count(one.closed, true); };
    if (facts.closed.size() != peers.closed.size() || closed(facts) < closed(peers))
      out_.add("shells", where + std::to_string(closed(facts)) + " of " + std::to_string(facts.closed.size()) +
                             " closed, OpenCASCADE's " + std::to_string(closed(peers)) + " of " +
                             std::to_string(peers.closed.size()));
    out_.gap = std::max(out_.gap, facts.gap), out_.peer_gap = std::max(out_.peer_gap, peers.gap);
    if (!(facts.gap <= 1.5 * peers.gap + 1e-6 * facts.size)) out_.add("gap", where + both(facts.gap, peers.gap));
    const bool is_open = !facts.open_edges || *facts.open_edges > 0;
    if (is_open && peers.open_edges && *peers.open_edges == 0)
      out_.add("mesh",
               where + (facts.open_edges ? words(static_cast<double>(*facts.open_edges)) + " open edges" : "none"));
  }

  void compare_faces(std::size_t k, const std::string& where) {
    const ShapeFacts &facts = facts_[k], &peers = peers_[k];
    const std::vector<std::size_t>& match = matches_[k];
    for (std::size_t face = 0; face < match.size(); ++face) {
      const std::size_t other = match[face];
      if (other == peers.faces.size()) continue;
      const Measured &area = facts.faces[face].area, &peer = peers.faces[other].area;
      const double allowed = area.error + peer.error + facts.slack[face] + peers.slack[other] + 1e-9 * peer.value;
      const double difference = std::abs(area.value - peer.value);
      if (!(difference <= allowed))
        out_.add("area", where + "face " + std::to_string(face) + ": " + both(area.value, peer.value) +
                             ", gaps explain " + words(allowed));
      else if (peer.value > 0)
        out_.area = std::max(out_.area, difference / peer.value);
      const ShapeFace &ours = ours_.shapes[k].faces[face], &theirs = theirs_.shapes[k].faces[other];
      if (!is_same(ours.colour, theirs.colour)) out_.add("colours", where + "face " + std::to_string(face));
      if (face == other && *ours.name != *theirs.name)
        out_.add("names", where + "face " + std::to_string(face) + ": " + *ours.name + ", " + *theirs.name);
    }
  }

  /// Compares the volumes of all solids together: OpenCASCADE makes several of one that has several pieces.
  void compare_volumes(const ShapeFacts& facts, const ShapeFacts& peers, const std::string& where) {
    if (facts.volumes.empty() != peers.volumes.empty())
      return out_.add("volume", where + (facts.volumes.empty() ? "OpenCASCADE's alone" : "Tessera's alone"));
    const Measured volume = sum(facts.volumes), peer = sum(peers.volumes);
    const double slack = std::accumulate(facts.slack.begin(), facts.slack.end(), 0.0) +
                         std::accumulate(peers.slack.begin(), peers.slack.end(), 0.0);
    const double allowed = volume.error + peer.error + slack * facts.size / 3 + 1e-9 * peer.value;
    const double difference = std::abs(volume.value - peer.value);
    if (!(difference <= allowed))
      out_.add("volume", where + both(volume.value, peer.value) + ", gaps explain " + words(allowed));
    else if (peer.value > 0)
      out_.volume = std::max(out_.volume, difference / peer.value);
  }

  static Measured sum(const std::vector<Measured>& all) {
    Measured total;
    for (const Measured& one : all) total.value += one.value, total.error += one.error;
    return total;
  }

  void compare_instance(std::size_t k) {
    const Instance &ours = ours_.instances[k], &theirs = theirs_.instances[k];
    const std::string where = "instance " + std::to_string(k);
    if (*ours.name != *theirs.name) out_.add("names", where + ": " + *ours.name + ", " + *theirs.name);
    if (!is_same(ours.colour, theirs.colour)) out_.add("colours", where);
    if (ours.shape != theirs.shape) return out_.add("places", where + " is of another shape");
    const ShapeFacts &facts = facts_[ours.shape], &peers = peers_[ours.shape];
    for (std::size_t face = 0; face < matches_[ours.shape].size(); ++face) {
      const std::size_t other = matches_[ours.shape][face];
      if (other == peers.faces.size()) continue;
      const SurfaceMeasures &own = facts.faces[face], &peer = peers.faces[other];
      const double distance =
          length(ours.placement->point(own.centroid.value) - theirs.placement->point(peer.centroid.value));
      const double lost = std::abs(own.area.value - peer.area.value) / std::max(peer.area.value, 1e-300);
      const double allowed = own.centroid.error + peer.centroid.error + (1e-6 + 2 * lost) * facts.size;
      if (!(distance <= 2 * allowed * ours.placement->norm_bound()))
        return out_.add("places", where + ": face " + std::to_string(face) + " is " + words(distance) + " away");
    }
  }

  static bool is_same(const std::optional<Colour>& a, const std::optional<Colour>& b) {
    if (!a || !b) return a.has_value() == b.has_value();
    const auto near = [](float x, float y) { return std::abs(x - y) <= 1e-5F; };
    return near(a->red, b->red) && near(a->green, b->green) && near(a->blue, b->blue) && near(a->alpha, b->alpha);
  }

  const Model &ours_, &theirs_;
  StepComparison out_;
  std::vector<ShapeFacts> facts_, peers_;
  std::vector<std::vector<std::size_t>> matches_;
};

}  // namespace

void StepComparison::add(const std::string& kind, const std::string& finding) {
  kinds.insert(kind);
  findings.push_back(kind + ": " + finding);
}

StepComparison compare_models(const Result<Model>& ours, const Result<Model>& theirs) {
  if (ours && theirs) return Comparison(*ours, *theirs).run();
  StepComparison out;
  if (ours || theirs)
    out.add(ours ? "read by Tessera alone" : "read by OpenCASCADE alone", (ours ? theirs : ours).status().message());
  return out;
}

}  // namespace tessera::test
