#pragma once
// Trimmed faces whose kept part is a closed formula, by classes: holes, slits, loops that touch, seams with and without
// gaps, poles that are cut off, tiny loops; and rays at them, most of them beside loops.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "support/outlines.h"
#include "support/quadrics.h"
#include "support/ray_classes.h"
#include "tessera/model.h"
#include "tessera/ray_scene.h"

namespace tessera::test {

/// A surface and what its outlines keep: points inside of an odd number of them, or, if all are holes, of an even one.
struct OutlinedFace {
  OutlinedFace(ModelSurface of, std::vector<Outline> by) : surface(std::move(of)), outlines(std::move(by)) {
    std::vector<TrimLoop> loops;
    for (const Outline& outline : outlines) loops.push_back(outline.loop);
    surface.trims = std::move(loops);
    grid = std::make_shared<const PatchGrid>(value_of(to_bezier(surface)));
  }
  /// At most the distance from the loops; above 0 where the face is kept.
  Real depth(Real u, Real v) const {
    bool kept = std::ranges::all_of(outlines, [](const Outline& of) { return of.loop.hole; });
    Real nearest = std::numeric_limits<Real>::infinity();
    for (const Outline& outline : outlines) {
      const Real depth = outline.depth(u, v);
      kept ^= depth > 0;
      nearest = std::min(nearest, std::abs(depth));
    }
    return kept ? nearest : -nearest;
  }
  /// By how much the depth changes at most along these ways.
  Real change(Real wide, Real high) const {
    Real by_u = 0;
    for (const Outline& outline : outlines) by_u = std::max(by_u, outline.change_by_u);
    return by_u * wide + high;
  }
  /// What rounding may make of the loops' numbers: within this distance of a loop a point may be kept or not.
  Real margin() const {
    const Domain d = grid->domain();
    return 0x1p-47L * std::max({std::abs(d.u0), std::abs(d.u1), std::abs(d.v0), std::abs(d.v1)});
  }

  ModelSurface surface;
  std::vector<Outline> outlines;  ///< in the parameters of the grid
  std::shared_ptr<const PatchGrid> grid;
};

/// Faces, rays at them, and how far they are apart.
struct TrimmedCase {
  std::vector<OutlinedFace> faces = {};
  std::shared_ptr<const PatchSet> set = {};
  std::shared_ptr<const RayScene> scene = {};
  double size = 1;
  std::vector<BezierPatch> patches = {};   ///< whole ones, of all faces
  std::vector<std::uint32_t> face = {};    ///< by patch
  std::vector<Domain> domains = {};        ///< by patch
  std::vector<ParameterPoint> focus = {};  ///< places of the first face at which half of all rays aim
  bool is_joined = false;  ///< the first loop of the first face is that of the second: no ray passes between them
  double gap = 0;          ///< a bound of the distance between them
  double reach = 0;        ///< how far the loops are apart in the parameters, at most
};

/// Trimmed faces that are difficult in one way.
struct TrimmedClass {
  std::string name;
  std::vector<TrimmedCase> cases;
};

namespace trimmed {

/// Patches are listed and the scene is made of a set.
inline void finish(TrimmedCase& of, PatchSet set) {
  of.set = std::make_shared<const PatchSet>(std::move(set));
  of.scene = std::make_shared<const RayScene>(value_of(RayScene::make(*of.set)));
  of.size = of.set->box().diagonal();
  for (std::uint32_t face = 0; face < of.faces.size(); ++face) {
    const PatchGrid& grid = *of.faces[face].grid;
    for (std::size_t k = 0; k < grid.patches().size(); ++k) {
      of.patches.push_back(grid.patches()[k]);
      of.face.push_back(face);
      of.domains.push_back(grid.patch_domain(k));
    }
  }
}

inline TrimmedCase alone(ModelSurface surface, std::vector<Outline> outlines, std::vector<ParameterPoint> focus = {}) {
  TrimmedCase out{.faces = {OutlinedFace(std::move(surface), std::move(outlines))}};
  out.focus = std::move(focus);
  Model model;
  model.surfaces = {out.faces[0].surface};
  finish(out, value_of(make_patch_set(model)));
  return out;
}

/// The outer face has a hole, and the inner one its plug; the curves of both loops run along the same edges.
inline TrimmedCase plugged(ModelSurface outer, const Outline& hole, ModelSurface inner, const Outline& plug,
                           double apart, double lift) {
  TrimmedCase out{.faces = {OutlinedFace(std::move(outer), {hole}), OutlinedFace(std::move(inner), {plug})}};
  out.is_joined = true;
  Shape shape;
  std::vector<Coedge> coedges;
  double steepest = 0, flattest = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 256; ++k) {
    const SurfaceJet jet = *out.faces[0].grid->evaluate_jet((k / 16 + 0.5) / 16, (k % 16 + 0.5) / 16);
    steepest = std::max(steepest, length(jet.du) + length(jet.dv));
    flattest = std::min(flattest, length(cross(jet.du, jet.dv)) / std::max(length(jet.du), length(jet.dv)));
  }
  const std::vector<Curve>& curves = hole.loop.curves;
  for (std::uint32_t k = 0; k < curves.size(); ++k) {
    const Vec3 at = position(curves[k], curves[k].domain().from);
    shape.vertices.push_back({out.faces[0].grid->evaluate_jet(at.x, at.y)->position});
    const auto next = static_cast<std::uint32_t>((k + 1) % curves.size());
    shape.edges.push_back({.start = k, .end = next, .range = curves[k].domain()});
    coedges.push_back({k, false});
  }
  for (OutlinedFace& face : out.faces) {
    TrimLoop loop = face.outlines[0].loop;
    loop.coedges = coedges;
    face.surface.trims = std::vector<TrimLoop>{loop};
    shape.faces.push_back({face.surface, {}, {}});
  }
  out.gap = 1.2 * steepest * apart + lift;
  out.reach = 2 * apart + 50 * lift / flattest;
  finish(out, value_of(make_patch_set(shape)));
  return out;
}

inline double wave(double u, double v) { return 0.3 * std::sin(4 * u + v) * std::cos(3 * v) + 0.1 * u * v; }

/// Points over the unit square, not quite even, with waves.
inline std::vector<Vec3> wavy_points(int count_u, int count_v) {
  Random random(11);
  std::vector<Vec3> points;
  for (int i = 0; i < count_u; ++i)
    for (int j = 0; j < count_v; ++j) {
      const double u = i / (count_u - 1.0), v = j / (count_v - 1.0);
      const Vec3 off = 0.1 / std::max(count_u, count_v) * uniform_vector(random, -1, 1);
      points.push_back(Vec3{u, v, wave(u, v)} + off);
    }
  return points;
}

inline std::vector<double> even_knots(int degree, int spans) {
  std::vector<double> knots(static_cast<std::size_t>(degree) + 1, 0.0);
  for (int k = 1; k < spans; ++k) knots.push_back(double(k) / spans);
  knots.insert(knots.end(), static_cast<std::size_t>(degree) + 1, 1.0);
  return knots;
}

/// Curved surfaces over [0, 1]^2: a bicubic patch, a rational patch of degrees 2 and 3, a bicubic spline of 4 x 3
/// patches.
inline std::vector<ModelSurface> surfaces() {
  Random random(12);
  const BezierPatch cubic = polynomial(3, 3, wavy_points(4, 4));
  const BezierPatch heavy = rational(2, 3, wavy_points(3, 4), random_weights(random, 2, 3, 0.4, 2.5));
  const BSplineSurface spline =
      value_of(BSplineSurface::polynomial(3, even_knots(3, 4), 3, even_knots(3, 3), wavy_points(7, 6)));
  return {{.name = std::string("cubic"), .surface = cubic},
          {.name = std::string("rational"), .surface = heavy},
          {.name = std::string("spline"), .surface = spline}};
}

/// A ring of corners about a point; the radius of each is off by at most `uneven` of it.
inline std::vector<ParameterPoint> ring(double u, double v, double radius, int count, double turn, double uneven,
                                        std::uint64_t seed) {
  Random random(seed);
  std::vector<ParameterPoint> corners;
  for (int k = 0; k < count; ++k) {
    const double angle = turn + 2 * std::numbers::pi * k / count, r = radius * (1 + uniform(random, -uneven, uneven));
    corners.push_back({u + r * std::cos(angle), v + r * std::sin(angle)});
  }
  return corners;
}

/// A loop around most of the domain, two round holes, one with corners and one with curved sides.
inline TrimmedClass holes() {
  TrimmedClass out{"trimmed, holes", {}};
  const std::vector<Outline> loops = {straight_outline({{0.05, 0.03}, {0.97, 0.06}, {0.93, 0.95}, {0.08, 0.91}}, false),
                                      round_outline(0.3, 0.31, 0.17, true, 0.4), round_outline(0.7, 0.25, 0.11, true),
                                      straight_outline(ring(0.72, 0.66, 0.16, 7, 0.1, 0.3, 3), true),
                                      strip_outline({0.15, 0.5, {0.6, 0.8, 0.5, 0.7}}, 0.12, true)};
  for (const ModelSurface& surface : surfaces()) {
    out.cases.push_back(alone(surface, loops));
    out.cases.push_back(alone(surface, {round_outline(0.5, 0.5, 0.3, true, 1.1)}));
  }
  return out;
}

/// Holes of a millionth of the domain's width, straight and curved, and faces as thin.
inline TrimmedClass slits() {
  TrimmedClass out{"trimmed, slits", {}};
  const double w = 1e-6;
  for (const ModelSurface& surface : surfaces()) {
    const std::vector<ParameterPoint> thin = {{0.11, 0.2}, {0.83, 0.37}, {0.83, 0.37 + w}, {0.11, 0.2 + w}};
    const Graph curved{0.1, 0.9, {0.7, 0.9, 0.5, 0.8}};
    out.cases.push_back(alone(surface, {straight_outline(thin, true), strip_outline(curved, w, true)}));
    out.cases.push_back(alone(surface, {strip_outline(curved, w, false)}));
    out.cases.push_back(
        alone(surface, {straight_outline({{0.4, 0.1}, {0.4 + w, 0.5}, {0.4, 0.9}}, true)}, {{0.4, 0.1}}));
  }
  return out;
}

/// Loops that touch each other or a side of the domain in a point.
inline TrimmedClass tangent_loops() {
  TrimmedClass out{"trimmed, tangent loops", {}};
  for (const ModelSurface& surface : surfaces()) {
    for (const double turn : {0.0, 0.5}) {  // with and without ends of arcs at the point
      const std::vector<Outline> pair = {round_outline(0.3125, 0.5, 0.1875, true, turn),
                                         round_outline(0.6875, 0.5, 0.1875, true)};
      out.cases.push_back(alone(surface, pair, {{0.5, 0.5}}));
      const std::vector<Outline> nested = {round_outline(0.5, 0.5, 0.4375, false, turn),
                                           round_outline(0.6875, 0.5, 0.25, true)};
      out.cases.push_back(alone(surface, nested, {{0.9375, 0.5}}));
    }
    out.cases.push_back(alone(surface, {round_outline(0.25, 0.5, 0.25, true), round_outline(0.625, 0.75, 0.25, true)},
                              {{0, 0.5}, {0.625, 1}}));
    const std::vector<Outline> corner = {straight_outline({{0.1, 0.25}, {0.9, 0.25}, {0.5, 0.05}}, true),
                                         straight_outline({{0.4, 0.25}, {0.75, 0.8}, {0.2, 0.9}}, true)};
    out.cases.push_back(alone(surface, corner, {{0.4, 0.25}}));
  }
  return out;
}

/// Holes and faces of a ten-millionth of the domain's width.
inline TrimmedClass tiny_loops() {
  TrimmedClass out{"trimmed, tiny loops", {}};
  const double r = 5e-8;
  for (const ModelSurface& surface : surfaces()) {
    const std::vector<Outline> loops = {round_outline(0.31, 0.42, r, true, 0.3), round_outline(0.75, 0.5, r, true),
                                        straight_outline(ring(0.6, 0.7, r, 5, 0.2, 0.3, 4), true)};
    out.cases.push_back(alone(surface, loops, {{0.31, 0.42}, {0.75, 0.5}, {0.6, 0.7}}));
    out.cases.push_back(alone(surface, {round_outline(0.41, 0.37, r, false)}, {{0.41, 0.37}}));
  }
  return out;
}

/// Spheres, ellipsoids and cones that lack what lies about a pole.
inline TrimmedClass cut_off_poles() {
  TrimmedClass out{"trimmed, cut-off poles", {}};
  const Domain unit;
  const auto parallel = [](const Domain& domain, double v, bool above) {
    return side_outline(domain, {v, v, v, v}, above);
  };
  const std::array<double, 4> waves{0.85, 0.65, 0.95, 0.85};
  const ModelSurface ball{.name = std::string("ball"), .surface = value_of(make_nurbs_sphere({}, 1))};
  const ModelSurface cone{.name = std::string("cone"), .surface = value_of(make_nurbs_cone({}, 1, 0, 2))};
  for (const ModelSurface& surface : {ball, cone}) {
    out.cases.push_back(alone(surface, {parallel(unit, 0.9, false)}));
    out.cases.push_back(alone(surface, {parallel(unit, 1 - 1e-6, false)}, {{0.3, 1 - 1e-6}}));
    out.cases.push_back(alone(surface, {side_outline(unit, waves, false)}));
    out.cases.push_back(alone(surface, {round_outline(0.4, 1, 0.2, true)}));
  }
  const QuadricPiece egg =
      piece(quadric({.a = 0.25, .b = 1, .c = 4, .k = -1}), {-1, 5, -std::numbers::pi / 2, std::numbers::pi / 2});
  for (const double latitude : {1.2, 1.5}) {
    const PatchGrid grid = value_of(to_bezier(ModelSurface{.name = {}, .surface = egg}));
    const auto next = std::ranges::upper_bound(grid.breaks_v(), latitude);
    const Real middle = (Real(next[-1]) + next[0]) / 2, half = (Real(next[0]) - next[-1]) / 2;
    const Real cut = middle + half * std::tan((latitude - middle) / 2) / std::tan(half / 2);
    TrimmedCase one = alone({.name = std::string("egg"), .surface = egg}, {parallel(egg.range(), latitude, false)});
    Outline& outline = one.faces[0].outlines[0];  // a quadric's own angles are not those of its patches
    const Domain range = egg.range();
    outline.depth = [=](Real, Real v) { return cut - v; };
    outline.draw = [=](Random& random) -> OutlinePlace { return {uniform(random, range.u0, range.u1), cut, 0, 1}; };
    out.cases.push_back(std::move(one));
  }
  return out;
}

/// Holes and plugs that fit: of the same surface, and of one with u and v exchanged.
inline TrimmedClass tight_seams() {
  TrimmedClass out{"trimmed, seams without gaps", {}};
  for (const ModelSurface& surface : surfaces()) {
    const std::vector<ParameterPoint> corners = ring(0.55, 0.45, 0.3, 5, 0.3, 0.3, 6);
    const Outline hole = round_outline(0.5, 0.5, 0.3, true, 0.7), plug = round_outline(0.5, 0.5, 0.3, false, 0.7);
    const Outline corner_hole = straight_outline(corners, true), corner_plug = straight_outline(corners, false);
    out.cases.push_back(plugged(surface, hole, surface, plug, 0, 0));
    out.cases.push_back(plugged(surface, corner_hole, surface, corner_plug, 0, 0));
    const BezierPatch* const patch = std::get_if<BezierPatch>(&surface.surface);
    if (patch == nullptr) continue;
    const ModelSurface turned{.name = std::string("turned"), .surface = transposed(*patch)};
    out.cases.push_back(plugged(surface, hole, turned, mirrored(plug), 0, 0));
    out.cases.push_back(plugged(surface, corner_hole, turned, mirrored(corner_plug), 0, 0));
  }
  return out;
}

/// Plugs that are too narrow, have corners elsewhere, or lie above their holes.
inline TrimmedClass gaping_seams() {
  TrimmedClass out{"trimmed, seams with gaps", {}};
  for (const double gap : {1e-3, 1e-6, 1e-9})
    for (const ModelSurface& surface : surfaces()) {
      ModelSurface above = surface;
      above.placement = Affine::translated({0, 0, gap});
      const Outline hole = round_outline(0.5, 0.5, 0.3, true, 0.7);
      const Outline plug = round_outline(0.5, 0.5, 0.3 - gap, false, 0.7);
      out.cases.push_back(plugged(surface, hole, surface, plug, gap, 0));
      out.cases.push_back(plugged(surface, hole, above, plug, gap, gap));
      std::vector<ParameterPoint> corners = ring(0.55, 0.45, 0.3, 5, 0.3, 0.3, 6), moved = corners;
      Random random(7);
      for (ParameterPoint& p : moved) p.u += uniform(random, -gap, gap) / 2, p.v += uniform(random, -gap, gap) / 2;
      out.cases.push_back(
          plugged(surface, straight_outline(corners, true), above, straight_outline(moved, false), gap, gap));
    }
  return out;
}

/// A ray at a place of a face, at a sine of `least` or more to the surface there.
inline Ray through(const TrimmedCase& of, const SurfaceJet& jet, double least, Random& random) {
  const Vec3 normal = normalized(cross(jet.du, jet.dv));
  for (;;) {
    const Vec3 direction = rays::unit_vector(random);
    if (std::abs(dot(direction, normal)) < least) continue;
    return rays::from_to(jet.position - uniform(random, 1, 2) * of.size * direction,
                         uniform(random, 0.5, 2) * direction);
  }
}

}  // namespace trimmed

/// A ray at a case: one in eight anywhere at a face, the others 1e-1 to 1e-13 of the parameters beside a loop, on
/// either side, or at it. One in eight grazes the surface. A second try at a part that is kept makes these more.
inline Ray draw_ray(const TrimmedCase& of, Random& random) {
  for (int tries = 0;; ++tries) {
    const std::size_t which = of.focus.empty() ? random() % of.faces.size() : 0;
    const OutlinedFace& face = of.faces[which];
    const Domain domain = face.grid->domain();
    const double off = random() % 32 == 0 ? 0 : rays::power(random, 1e-13, 1e-1) * (random() % 2 == 0 ? 1 : -1);
    Real u = domain.u_at(uniform(random, 0, 1)), v = domain.v_at(uniform(random, 0, 1));
    if (!of.focus.empty() && random() % 2 == 0) {
      const ParameterPoint at = of.focus[random() % of.focus.size()];
      const Real angle = uniform(random, 0, 2 * std::numbers::pi);
      u = at.u + off * std::cos(angle), v = at.v + off * std::sin(angle);
    } else if (random() % 8 != 0) {
      const OutlinePlace at = face.outlines[random() % face.outlines.size()].draw(random);
      u = at.u + off * at.normal_u, v = at.v + off * at.normal_v;
    }
    if (tries == 0 && face.depth(u, v) < 0) continue;
    const std::optional<SurfaceJet> jet = face.grid->evaluate_jet(static_cast<double>(u), static_cast<double>(v));
    if (!jet || !(length(cross(jet->du, jet->dv)) > 0)) continue;
    const bool grazes = !of.is_joined && random() % 8 == 0;
    return trimmed::through(of, *jet, grazes ? 1e-3 : 0.1, random);
  }
}

inline std::vector<TrimmedClass> trimmed_classes() {
  using namespace trimmed;
  return {holes(), slits(), tangent_loops(), tight_seams(), gaping_seams(), cut_off_poles(), tiny_loops()};
}

}  // namespace tessera::test
