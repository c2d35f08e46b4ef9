#include "peers/true_face.h"

#include <BRepGProp.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <Geom_Curve.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Vertex.hxx>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "support/triangle_distance.h"

namespace tessera::bench {
namespace {

constexpr int steps_per_edge = 64;
constexpr double infinity = std::numeric_limits<double>::infinity();

Vec3 vec3_of(const gp_Pnt& p) { return {p.X(), p.Y(), p.Z()}; }
Vec3 vec3_of(const gp_Vec& p) { return {p.X(), p.Y(), p.Z()}; }

}  // namespace

TrueFace::TrueFace(const TopoDS_Face& face, const FaceBox& box, const Reparametrization& map)
    : face_(face),
      surface_(face, Standard_False),
      sides_(std::make_unique<BRepTopAdaptor_FClass2d>(face, 1e-12)),
      box_(box.domain),
      map_(map),
      reversed_(face.Orientation() == TopAbs_REVERSED) {
  GProp_GProps of_area, of_length;
  BRepGProp::SurfaceProperties(face, of_area, 1e-6);
  BRepGProp::LinearProperties(face, of_length);
  area_ = std::abs(of_area.Mass());
  perimeter_ = of_length.Mass();
  for (TopExp_Explorer walk(face, TopAbs_EDGE); walk.More(); walk.Next()) {
    Edge edge;
    edge.curve = BRep_Tool::CurveOnSurface(TopoDS::Edge(walk.Current()), face, edge.from, edge.to);
    if (edge.curve.IsNull()) continue;
    for (int k = 0; k <= steps_per_edge; ++k) {
      const double t = edge.from + (edge.to - edge.from) * k / steps_per_edge;
      const gp_Pnt2d at = edge.curve->Value(t);
      edge.parameters.push_back({at.X(), at.Y()});
      edge.points.push_back(point({at.X(), at.Y()}));
    }
    edges_.push_back(std::move(edge));
  }
  measure_gaps();
}

void TrueFace::measure_gaps() {
  std::map<const void*, std::vector<Vec3>> ends;
  for (TopExp_Explorer walk(face_, TopAbs_EDGE); walk.More(); walk.Next()) {
    const TopoDS_Edge edge = TopoDS::Edge(walk.Current());
    double from = 0, to = 0, from3 = 0, to3 = 0;
    const Handle(Geom2d_Curve) curve = BRep_Tool::CurveOnSurface(edge, face_, from, to);
    if (curve.IsNull()) continue;
    const auto at = [&](double t) {
      const gp_Pnt2d p = curve->Value(t);
      return point({p.X(), p.Y()});
    };
    const TopoDS_Edge forward = TopoDS::Edge(edge.Oriented(TopAbs_FORWARD));
    ends[TopExp::FirstVertex(forward).TShape().get()].push_back(at(from));
    ends[TopExp::LastVertex(forward).TShape().get()].push_back(at(to));
    const Handle(Geom_Curve) in_space = BRep_Tool::Curve(edge, from3, to3);
    if (in_space.IsNull()) continue;
    for (int k = 0; k <= 16; ++k)
      edge_gap_ = std::max(edge_gap_, length(vec3_of(in_space->Value(from3 + (to3 - from3) * k / 16)) -
                                             at(from + (to - from) * k / 16)));
  }
  for (const auto& [vertex, points] : ends)
    for (const Vec3& p : points)
      for (const Vec3& q : points) wire_gap_ = std::max(wire_gap_, length(p - q));
}

Vec3 TrueFace::point(const Parameters& at) const { return vec3_of(surface_.Value(at[0], at[1])); }

Vec3 TrueFace::normal(const Parameters& at) const {
  gp_Pnt position;
  gp_Vec along_u, along_v;
  surface_.D1(at[0], at[1], position, along_u, along_v);
  return normalized(cross(vec3_of(along_u), vec3_of(along_v)));
}

Parameters TrueFace::theirs(const Parameters& ours) const {
  const double u = reversed_ ? ours[1] : ours[0], v = reversed_ ? ours[0] : ours[1];
  return {map_.u ? map_.u->angle(u) : u, map_.v ? map_.v->angle(v) : v};
}
Parameters TrueFace::ours(const Parameters& theirs) const {
  const Parameters at = map_(theirs[0], theirs[1]);
  return reversed_ ? Parameters{at[1], at[0]} : at;
}

bool TrueFace::contains(const Parameters& at) const {
  const TopAbs_State state = sides_->Perform(gp_Pnt2d(at[0], at[1]));
  return state == TopAbs_IN || state == TopAbs_ON;
}

Vec3 TrueFace::point_of(const Edge& edge, double t) const {
  const gp_Pnt2d at = edge.curve->Value(t);
  return point({at.X(), at.Y()});
}

// The nearest of the chords, then the nearest point of the curve beside it.
double TrueFace::distance_from_border(const Vec3& p) const {
  double nearest = infinity;
  for (const Edge& edge : edges_) {
    std::size_t best = 0;
    double least = infinity;
    for (std::size_t k = 0; k + 1 < edge.points.size(); ++k) {
      const double distance = test::distance_to_segment(p, edge.points[k], edge.points[k + 1]);
      if (distance < least) least = distance, best = k;
    }
    double step = 0;  // how far a chord may lie off
    step = length(edge.points[best + 1] - edge.points[best]);
    if (least - step > nearest) continue;
    const double width = (edge.to - edge.from) / steps_per_edge;
    double low = edge.from + width * (static_cast<double>(best) - 1), high = low + 3 * width;
    low = std::max(low, edge.from), high = std::min(high, edge.to);
    constexpr double golden = 0.6180339887498949;
    for (int k = 0; k < 40; ++k) {
      const double a = high - golden * (high - low), b = low + golden * (high - low);
      if (length(point_of(edge, a) - p) < length(point_of(edge, b) - p))
        high = b;
      else
        low = a;
    }
    nearest = std::min({nearest, length(point_of(edge, (low + high) / 2) - p), length(edge.points[best] - p),
                        length(edge.points[best + 1] - p)});
  }
  return nearest;
}

// Gauss and Newton's steps, halved until they lead nearer.
double TrueFace::distance(const Vec3& p, const Parameters& start) const {
  const auto clamped = [&](double u, double v) {
    return Parameters{std::clamp(u, box_.u0, box_.u1), std::clamp(v, box_.v0, box_.v1)};
  };
  Parameters at = clamped(start[0], start[1]);
  double least = length(point(at) - p);
  for (int step = 0; step < 12; ++step) {
    gp_Pnt position;
    gp_Vec along_u, along_v;
    surface_.D1(at[0], at[1], position, along_u, along_v);
    const Vec3 du = vec3_of(along_u), dv = vec3_of(along_v), off = p - vec3_of(position);
    const double a = dot(du, du) * (1 + 1e-12), b = dot(du, dv), c = dot(dv, dv) * (1 + 1e-12);
    const double e = dot(du, off), f = dot(dv, off), det = a * c - b * b;
    double x = det > 0 ? (e * c - f * b) / det
               : a > 0 ? e / a
                       : 0,
           y = det > 0 ? (a * f - b * e) / det
               : c > 0 ? f / c
                       : 0;
    bool nearer = false;
    for (int halved = 0; halved < 6 && !nearer; ++halved, x /= 2, y /= 2) {
      const Parameters next = clamped(at[0] + x, at[1] + y);
      const double distance = length(point(next) - p);
      if (!(distance < least)) continue;
      nearer = least - distance > 1e-9 * least;
      least = distance, at = next;
      if (!nearer) break;
    }
    if (!nearer) break;
  }
  return contains(at) ? least : distance_from_border(p);
}

double TrueFace::border_share(const Parameters& at) const {
  double nearest = infinity;
  const double width = box_.u1 - box_.u0, height = box_.v1 - box_.v0;
  const auto scaled = [&](const Parameters& p) { return Vec3{p[0] / width, p[1] / height, 0}; };
  for (const Edge& edge : edges_) {
    const auto share = [&](double t) {
      const gp_Pnt2d q = edge.curve->Value(t);
      return length(scaled({q.X(), q.Y()}) - scaled(at));
    };
    for (std::size_t k = 0; k + 1 < edge.points.size(); ++k) {
      const Vec3 a = scaled(edge.parameters[k]), b = scaled(edge.parameters[k + 1]);
      if (test::distance_to_segment(scaled(at), a, b) - length(b - a) > nearest) continue;
      double low = edge.from + (edge.to - edge.from) * static_cast<double>(k) / steps_per_edge,
             high = low + (edge.to - edge.from) / steps_per_edge;
      for (int halved = 0; halved < 60; ++halved) {
        const double first = low + (high - low) * 0.382, second = low + (high - low) * 0.618;
        (share(first) < share(second) ? high : low) = share(first) < share(second) ? second : first;
      }
      nearest = std::min(nearest, share((low + high) / 2));
    }
  }
  return nearest;
}

Parameters TrueFace::random(std::mt19937& generator) const {
  std::uniform_real_distribution<double> uniform(0, 1);
  const double u = uniform(generator), v = uniform(generator);
  return {box_.u0 + u * (box_.u1 - box_.u0), box_.v0 + v * (box_.v1 - box_.v0)};
}

std::vector<Vec3> TrueFace::border_points(std::size_t per_edge) const {
  std::vector<Vec3> points;
  for (const Edge& edge : edges_)
    for (std::size_t k = 0; k < per_edge; ++k)
      points.push_back(point_of(
          edge, edge.from + (edge.to - edge.from) * (static_cast<double>(k) + 0.5) / static_cast<double>(per_edge)));
  return points;
}

}  // namespace tessera::bench
