#include "io/cad/face_bytes.h"

#include <vector>

namespace tessera { inline namespace abi_0_1 {
namespace {

void put_surface(ByteWriter& out, const BSplineSurface& surface) {
  out.put(surface.degree_u());
  out.put(surface.degree_v());
  out.put_list(surface.knots_u());
  out.put_list(surface.knots_v());
  out.put_list(surface.points());
  out.put_list(surface.weights());
  out.put(surface.domain());
}

bool take_surface(ByteReader& in, std::optional<BSplineSurface>& surface) {
  int degree_u = 0, degree_v = 0;
  std::vector<double> knots_u, knots_v, weights;
  std::vector<Vec3> points;
  Domain domain;
  const bool whole = in.take(degree_u) && in.take(degree_v) && in.take_list(knots_u) && in.take_list(knots_v) &&
                     in.take_list(points) && in.take_list(weights) && in.take(domain);
  if (!whole) return false;
  const Result<BSplineSurface> made =
      weights.empty() ? BSplineSurface::polynomial(degree_u, knots_u, degree_v, knots_v, points, domain)
                      : BSplineSurface::rational(degree_u, knots_u, degree_v, knots_v, points, weights, domain);
  if (made) surface = *made;
  return made.ok();
}

void put_loops(ByteWriter& out, const std::vector<TrimLoop>& loops) {
  out.put_count(loops.size());
  for (const TrimLoop& loop : loops) {
    out.put(loop.hole);
    out.put_count(loop.curves.size());
    for (const Curve& curve : loop.curves) put_curve(out, curve);
    out.put_count(loop.coedges.size());
    for (const Coedge& coedge : loop.coedges) {
      out.put(coedge.edge);
      out.put(coedge.reversed);
      put_curve(out, coedge.parameter);
    }
  }
}

bool take_coedge(ByteReader& in, std::vector<Coedge>& coedges) {
  Coedge& coedge = coedges.emplace_back();
  return in.take(coedge.edge) && in.take(coedge.reversed) && take_curve(in, coedge.parameter);
}

bool take_loop(ByteReader& in, std::vector<TrimLoop>& loops) {
  TrimLoop& loop = loops.emplace_back();
  const auto take_one = [&](std::vector<Curve>& curves) {
    std::optional<Curve> curve;
    if (!take_curve(in, curve) || !curve) return false;
    curves.push_back(*std::move(curve));
    return true;
  };
  return in.take(loop.hole) && in.take_each(loop.curves, take_one) &&
         in.take_each(loop.coedges, [&](std::vector<Coedge>& coedges) { return take_coedge(in, coedges); });
}

bool take_loops(ByteReader& in, Shared<std::vector<TrimLoop>>& shared) {
  std::vector<TrimLoop> loops;
  if (!in.take_each(loops, [&](std::vector<TrimLoop>& list) { return take_loop(in, list); })) return false;
  shared = std::move(loops);
  return true;
}

Status put_placed(ByteWriter& out, const ModelSurface& face) {
  const BSplineSurface* const spline = std::get_if<BSplineSurface>(&face.surface);
  if (!spline) return Status(StatusCode::internal, "a surface of this kind has no form as bytes");
  out.put_text(*face.name);
  put_surface(out, *spline);
  out.put(*face.placement);
  put_loops(out, face.trims);
  return {};
}

std::optional<ModelSurface> take_placed(ByteReader& in) {
  std::string name;
  std::optional<BSplineSurface> spline;
  Affine placement;
  if (!in.take_list(name) || !take_surface(in, spline) || !in.take(placement)) return {};
  ModelSurface face{std::move(name), *std::move(spline), placement};
  if (!take_loops(in, face.trims)) return {};
  return face;
}

}  // namespace

void put_curve(ByteWriter& out, const std::optional<Curve>& curve) {
  out.put(curve ? curve->degree() : 0);
  if (!curve) return;
  out.put_list(curve->points());
  out.put_list(curve->weights());
  out.put_list(curve->knots());
  out.put(curve->domain());
}

bool take_curve(ByteReader& in, std::optional<Curve>& curve) {
  int degree = 0;
  if (!in.take(degree)) return false;
  if (degree == 0) return true;
  std::vector<Vec3> points;
  std::vector<double> weights, knots;
  Interval domain;
  if (!in.take_list(points) || !in.take_list(weights) || !in.take_list(knots) || !in.take(domain)) return false;
  const Result<Curve> made = weights.empty() ? Curve::b_spline(degree, points, knots, domain)
                                             : Curve::nurbs(degree, points, weights, knots, domain);
  if (made) curve = *made;
  return made.ok();
}

void put_colour(ByteWriter& out, const std::optional<Colour>& colour) {
  out.put(colour.has_value());
  if (colour) out.put(*colour);
}

bool take_colour(ByteReader& in, std::optional<Colour>& colour) {
  bool coloured = false;
  if (!in.take(coloured) || !coloured) return !coloured;
  Colour value;
  if (!in.take(value)) return false;
  for (const float part : {value.red, value.green, value.blue, value.alpha})
    if (!(part >= 0 && part <= 1)) return false;
  colour = value;
  return true;
}

Status put_surfaces(ByteWriter& out, std::span<const ModelSurface> surfaces) {
  out.put_count(surfaces.size());
  for (const ModelSurface& surface : surfaces)
    if (Status status = put_placed(out, surface); !status.ok()) return status;
  return {};
}

bool take_surfaces(ByteReader& in, std::vector<ModelSurface>& surfaces) {
  return in.take_each(surfaces, [&](std::vector<ModelSurface>& list) {
    std::optional<ModelSurface> surface = take_placed(in);
    if (surface) list.push_back(*std::move(surface));
    return surface.has_value();
  });
}

Status put_faces(ByteWriter& out, std::span<const ShapeFace> faces) {
  out.put_count(faces.size());
  for (const ShapeFace& face : faces) {
    if (Status status = put_placed(out, face); !status.ok()) return status;
    put_loops(out, face.outline);
    put_colour(out, face.colour);
  }
  return {};
}

bool take_faces(ByteReader& in, std::vector<ShapeFace>& faces) {
  return in.take_each(faces, [&](std::vector<ShapeFace>& list) {
    std::optional<ModelSurface> surface = take_placed(in);
    if (!surface) return false;
    ShapeFace& face = list.emplace_back(ShapeFace{*std::move(surface)});
    return take_loops(in, face.outline) && take_colour(in, face.colour);
  });
}

}}  // namespace tessera::abi_0_1
