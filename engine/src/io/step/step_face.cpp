#include "io/step/step_face.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "exact/transposed.h"
#include "io/step/step_face_box.h"
#include "io/step/step_inverse.h"
#include "io/step/step_outline.h"
#include "io/step/step_trace.h"
#include "io/step/step_trim_curves.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The box of a face's edges and vertices, and the edges' curves.
Result<Box3> extent_of_face(const StepFace& face, const StepFaceContext& context, std::vector<const Curve*>& curves) {
  Box3 out;
  for (const StepBound& bound : face.bounds) {
    if (bound.vertex != no_id) out.extend(context.vertices[bound.vertex].position);
    for (const StepEdgeUse& use : bound.uses) {
      const std::optional<Curve>& curve = context.edges[use.edge].curve;
      if (!curve) return Status(StatusCode::unsupported, "an edge of it cannot be read");
      for (const Vec3& p : curve->points()) out.extend(p);
      curves.push_back(&*curve);
    }
  }
  return out;
}

StepOwnEdge pole_edge(std::uint32_t vertex, const StepOwnEdge::Use& use) {
  StepOwnEdge out{{}, {use}};
  out.edge.start = out.edge.end = vertex;
  out.edge.degenerate = true;
  return out;
}

/// A surface that is a face by itself.
Result<StepFaceResult> whole_surface(const StepFace& face, BSplineSurface surface, double tolerance) {
  StepFaceResult out{std::move(surface), {}, true, {}, 0, false};
  // Before it has an outline, which runs counter-clockwise on the turned surface.
  if (!face.agrees)
    if (Status status = turn_around(out.surface, out.loops); !status.ok()) return status;
  if (Status status = add_outline(out, tolerance); !status.ok()) return status;
  return out;
}

/// Converts a face whose surface is known.
Result<StepFaceResult> face_on(const SurfaceInverse& inverse, const StepFace& face, const StepFaceContext& context,
                               const Box3& extent) {
  const EdgeTracer tracer(inverse, context.edges, face.agrees);
  std::vector<LoopTrace> loops;
  std::vector<ParameterPoint> vertices;
  for (const StepBound& bound : face.bounds) {
    if (bound.vertex != no_id) vertices.push_back(inverse.find(context.vertices[bound.vertex].position));
    if (!bound.uses.empty()) loops.push_back(tracer.loop(bound, context.reversed_curves));
  }
  const bool is_hole = keep_outside(inverse, loops, face.agrees);
  const Result<FaceBox> box =
      step_face_box(inverse, context.edges, loops, vertices, face.agrees, 2e-3 * context.tolerance);
  if (!box) return box.status();
  Result<FaceSurface> surface = inverse.surface(box->domain);
  if (!surface) return surface.status();
  if (loops.empty()) return whole_surface(face, std::move(surface->surface), context.tolerance);
  StepFaceResult out{std::move(surface->surface), {}, false, {}, inverse.fit_error(), false};
  // Below the rounding of places, no curve would be near enough.
  const double rounding = 2e-14 * std::max(max_abs(extent.lower), max_abs(extent.upper));
  const double fit_tolerance = std::max(1e-3 * context.tolerance, rounding);
  TrimCurveMaker maker(inverse, surface->parameters, *box, fit_tolerance);
  const bool has_outer = std::ranges::any_of(loops, [](const LoopTrace& loop) { return loop.is_outer; });
  for (const LoopTrace& loop : loops) {
    TrimLoop& made = out.loops.emplace_back();
    made.hole = is_hole || (has_outer && !loop.is_outer);
    for (const EdgeTrace& piece : loop.pieces) {
      if (piece.edge == no_id)
        out.own_edges.push_back(pole_edge(piece.vertex, {out.loops.size() - 1, made.curves.size()}));
      const BrepEdge* const edge = piece.edge == no_id ? nullptr : &context.edges[piece.edge];
      if (Status status = maker.append(piece, edge, made); !status.ok()) return status;
    }
  }
  out.is_rough = maker.is_rough();
  out.whole = is_whole_box(out.loops, *box);
  if (!face.agrees)
    if (Status status = turn_around(out.surface, out.loops); !status.ok()) return status;
  return out;
}

/// Returns the plane through the points of a polygon, along whose normal it runs counter-clockwise, if the file states
/// no surface or one that does not hold the points; or else nullptr.
std::unique_ptr<SurfaceInverse> plane_of_polygon(const StepFace& face, const StepFaceContext& context,
                                                 const Box3& extent) {
  if (!face.is_polygon) return nullptr;
  std::vector<Vec3> points;
  Vec3 normal;
  for (const StepBound& bound : face.bounds) {
    std::vector<Vec3> loop;
    for (const StepEdgeUse& use : bound.uses) {
      const BrepEdge& edge = context.edges[use.edge];
      loop.push_back(context.vertices[use.reversed ? edge.end : edge.start].position);
    }
    Vec3 of_loop;  // twice its area, by Newell's sum
    for (std::size_t k = 0; k < loop.size(); ++k)
      of_loop += cross(loop[k] - loop.front(), loop[(k + 1) % loop.size()] - loop.front());
    if (bound.is_outer || length(of_loop) > length(normal)) normal = of_loop;
    points.insert(points.end(), loop.begin(), loop.end());
  }
  const Result<std::optional<StepElementary>> stated = face.surface == 0
                                                           ? Result<std::optional<StepElementary>>(std::nullopt)
                                                           : context.geometry.elementary(face.surface);
  const auto holds = [&](const Frame& frame) {
    return std::ranges::all_of(points, [&](const Vec3& p) { return std::abs(frame.local(p).z) <= context.tolerance; });
  };
  if (stated && *stated && (*stated)->kind == StepElementaryKind::plane && holds((*stated)->frame)) return nullptr;
  const Vec3 z = normalized(normal);
  if (points.empty() || z == Vec3{}) return nullptr;
  const Vec3 x = normalized(cross(z, std::abs(z.z) < 0.9 ? Vec3{0, 0, 1} : Vec3{1, 0, 0}));
  const Frame frame{points.front(), x, cross(z, x), z};
  if (face.surface != 0 && !holds(frame)) return nullptr;
  return SurfaceInverse::of_plane(frame, std::max(context.tolerance, 1e-12 * extent.diagonal()));
}

}  // namespace

Result<StepFaceResult> step_face(const StepFace& face, const StepFaceContext& context) {
  if (face.bounds.empty()) {
    Result<FaceSurface> made = context.geometry.surface(face.surface);
    if (!made) return made.status();
    return whole_surface(face, std::move(made->surface), context.tolerance);
  }
  std::vector<const Curve*> curves;
  const Result<Box3> extent = extent_of_face(face, context, curves);
  if (!extent) return extent.status();
  const std::unique_ptr<SurfaceInverse> polygon = plane_of_polygon(face, context, *extent);
  if (polygon) {
    StepFace turned = face;
    turned.agrees = true;
    return face_on(*polygon, turned, context, *extent);
  }
  const Result<std::unique_ptr<SurfaceInverse>> inverse =
      SurfaceInverse::make(context.geometry, face.surface, *extent, context.tolerance, curves);
  if (!inverse) return inverse.status();
  return face_on(**inverse, face, context, *extent);
}

}}  // namespace tessera::abi_0_1
