// Meshes of the same surfaces: Tessera's certified tessellation against OpenCASCADE's BRepMesh_IncrementalMesh, each in one
// thread. OpenCASCADE is given a deflection; how far its mesh really lies from the surface is measured, at 55 points of each
// triangle, and Tessera is given the largest tolerance by which its own mesh, measured in the same way, is at least as
// near. (Tessera's is proven besides: the bound stands beside what is measured.) Then the same of a plan of the fewest
// triangles, which takes more time. Time is that of all that leads from
// surfaces in memory, Bezier patches packed in a set or faces of a shape, to positions, normals and triangles.

#include <tbb/global_control.h>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_BezierSurface.hxx>
#include <Standard_Version.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColStd_Array2OfReal.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Face.hxx>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>

#include "convert/wavy_surface.h"
#include "peers/interleaved.h"
#include "peers/results.h"
#include "support/synthetic_sets.h"
#include "support/triangle_distance.h"
#include "tessera/certified_tessellation.h"
#include "tessera/model.h"
#include "tessera/spline_convert.h"

namespace tessera::bench {
namespace {

constexpr int rounds = 3;
constexpr double default_angle = 0.5;  // OpenCASCADE's own, radians

/// What is meshed. Parameters are those of a face.
struct Subject {
  std::string name;
  PatchSet set;
  std::vector<TopoDS_Face> faces;
  std::function<Vec3(std::size_t face, double u, double v)> at;
  /// A patch's place: its face, and where its parameters lie in those of the face.
  std::function<std::pair<std::size_t, Domain>(std::size_t patch)> place;
};

Handle(Geom_BSplineSurface) occt_surface(const BSplineSurface& surface, int spans, int degree) {
  TColgp_Array2OfPnt poles(1, spans + degree, 1, spans + degree);
  for (int i = 0; i < spans + degree; ++i)
    for (int j = 0; j < spans + degree; ++j) {
      const Vec3& p = surface.point(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
      poles.SetValue(i + 1, j + 1, gp_Pnt(p.x, p.y, p.z));
    }
  TColStd_Array1OfReal knots(1, spans + 1);
  TColStd_Array1OfInteger multiplicities(1, spans + 1);
  for (int k = 0; k <= spans; ++k) {
    knots.SetValue(k + 1, k);
    multiplicities.SetValue(k + 1, k == 0 || k == spans ? degree + 1 : 1);
  }
  return new Geom_BSplineSurface(poles, knots, knots, multiplicities, multiplicities, degree, degree);
}

Handle(Geom_BezierSurface) occt_surface(const BezierPatch& patch) {
  const int m = patch.degree_u(), n = patch.degree_v();
  TColgp_Array2OfPnt poles(1, m + 1, 1, n + 1);
  TColStd_Array2OfReal weights(1, m + 1, 1, n + 1);
  for (int i = 0; i <= m; ++i)
    for (int j = 0; j <= n; ++j) {
      const Vec3& p = patch.point(i, j);
      poles.SetValue(i + 1, j + 1, gp_Pnt(p.x, p.y, p.z));
      weights.SetValue(i + 1, j + 1, patch.weight(i, j));
    }
  return patch.is_rational() ? new Geom_BezierSurface(poles, weights) : new Geom_BezierSurface(poles);
}

TopoDS_Face face_of(const Handle(Geom_Surface) & surface) { return BRepBuilderAPI_MakeFace(surface, 1e-7).Face(); }

Subject spline_subject(int spans) {
  constexpr int degree = 3;
  const BSplineSurface surface = test::value_of(wavy_surface(spans, degree, false));
  const PatchGrid grid = test::value_of(to_bezier(surface));
  Subject subject{"B-spline, one face of " + std::to_string(spans) + " x " + std::to_string(spans) + " spans",
                  test::value_of(make_patch_set({&grid, 1})),
                  {face_of(occt_surface(surface, spans, degree))},
                  [surface](std::size_t, double u, double v) { return evaluate_jet(surface, u, v).position; },
                  {}};
  std::vector<Domain> domains;
  for (std::size_t k = 0; k < subject.set.patch_count(); ++k) domains.push_back(subject.set.source(k).domain);
  subject.place = [domains](std::size_t patch) { return std::pair{std::size_t{0}, domains[patch]}; };
  return subject;
}

Subject patches_subject(const std::string& name, const std::vector<BezierPatch>& patches) {
  Subject subject{name,
                  test::value_of(PatchSet::from(patches)),
                  {},
                  [patches](std::size_t face, double u, double v) { return de_casteljau(patches[face], u, v); },
                  [](std::size_t patch) {
                    return std::pair{patch, Domain{}};
                  }};
  for (const BezierPatch& patch : patches) subject.faces.push_back(face_of(occt_surface(patch)));
  return subject;
}

struct Triangle {
  std::size_t face;
  std::array<std::array<double, 2>, 3> parameters;
  std::array<Vec3, 3> corners;
};

/// The largest distance found of the surface from a triangle that stands for it.
double distance(const Subject& subject, const Triangle& t) {
  constexpr int steps = 9;  // 55 points
  double most = 0;
  for (int i = 0; i <= steps; ++i)
    for (int j = 0; i + j <= steps; ++j) {
      const double a = double(i) / steps, b = double(j) / steps, c = 1 - a - b;
      const auto mixed = [&](std::size_t k) {
        return a * t.parameters[0][k] + b * t.parameters[1][k] + c * t.parameters[2][k];
      };
      const Vec3 p = subject.at(t.face, mixed(0), mixed(1));
      most = std::max(most, test::distance_to_triangle(p, t.corners[0], t.corners[1], t.corners[2]));
    }
  return most;
}

/// A mesh's figures.
struct Measured {
  std::size_t triangles = 0;
  double error = 0, seconds = 0, bound = 0;
};

Measured measure_occt(const Subject& subject, double deflection) {
  TopoDS_Compound shape;
  BRep_Builder builder;
  builder.MakeCompound(shape);
  for (const TopoDS_Face& face : subject.faces) builder.Add(shape, face);
  Measured measured;
  const auto mesh = [&] {
    BRepTools::Clean(shape);
    return seconds_of([&] { BRepMesh_IncrementalMesh(shape, deflection, false, default_angle, false); });
  };
  measured.seconds = best_interleaved(rounds, {mesh})[0];
  for (std::size_t face = 0; face < subject.faces.size(); ++face) {
    TopLoc_Location location;
    const Handle(Poly_Triangulation) triangles = BRep_Tool::Triangulation(subject.faces[face], location);
    if (triangles.IsNull()) continue;
    measured.triangles += static_cast<std::size_t>(triangles->NbTriangles());
    for (int k = 1; k <= triangles->NbTriangles(); ++k) {
      int corner[3];
      triangles->Triangle(k).Get(corner[0], corner[1], corner[2]);
      Triangle t{face, {}, {}};
      for (std::size_t c = 0; c < 3; ++c) {
        const gp_Pnt2d uv = triangles->UVNode(corner[c]);
        const gp_Pnt p = triangles->Node(corner[c]);
        t.parameters[c] = {uv.X(), uv.Y()};
        t.corners[c] = {p.X(), p.Y(), p.Z()};
      }
      measured.error = std::max(measured.error, distance(subject, t));
    }
  }
  return measured;
}

Mesh mesh_of(const Subject& subject, const CertifiedOptions& options, double& bound) {
  const CertifiedTessellation plan = test::value_of(CertifiedTessellation::make(subject.set, options));
  Mesh mesh = test::value_of(plan.allocate());
  if (!plan.run(subject.set, mesh.views()).ok()) std::abort();
  bound = plan.bound();
  return mesh;
}

Measured measure_mesh(const Subject& subject, const CertifiedOptions& options) {
  Measured measured;
  const Mesh mesh = mesh_of(subject, options, measured.bound);
  measured.triangles = mesh.triangle_count();
  for (std::size_t k = 0; k < mesh.triangle_count(); ++k) {
    const auto [face, domain] = subject.place(mesh.patches[k]);
    Triangle t{face, {}, {}};
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t v = mesh.indices[3 * k + c];
      t.parameters[c] = {domain.u0 + double(mesh.parameters[2 * v]) * (domain.u1 - domain.u0),
                         domain.v0 + double(mesh.parameters[2 * v + 1]) * (domain.v1 - domain.v0)};
      t.corners[c] = mesh.origin + Vec3{mesh.positions[3 * v], mesh.positions[3 * v + 1], mesh.positions[3 * v + 2]};
    }
    measured.error = std::max(measured.error, distance(subject, t));
  }
  return measured;
}

/// Positions, normals and triangles, into memory that is there.
double seconds_of_mesh(const Subject& subject, const CertifiedOptions& options) {
  double bound = 0;
  Mesh mesh = mesh_of(subject, options, bound);
  MeshViews out = mesh.views();
  out.parameter = {};
  out.patch = {};
  const auto make = [&] {
    return seconds_of([&] {
      const auto plan = CertifiedTessellation::make(subject.set, options);
      if (!plan || !plan->run(subject.set, out).ok()) std::abort();
    });
  };
  return best_interleaved(rounds, {make})[0];
}

/// The coarsest mesh, nearly, whose measured error is at most that.
Measured measure_tessera(const Subject& subject, double error, bool fewest) {
  double tolerance = 2 * error;
  const auto options = [fewest](double within) { return CertifiedOptions{.tolerance = within, .fewest = fewest}; };
  std::optional<std::pair<double, Measured>> best;
  for (int step = 0; step < 12; ++step) {
    const Measured found = measure_mesh(subject, options(tolerance));
    if (found.error <= error && (!best || tolerance > best->first)) best = {tolerance, found};
    if (found.error <= error && found.error > 0.97 * error) break;
    tolerance *= 0.99 * error / found.error;
  }
  if (!best) best = {0.9 * error, measure_mesh(subject, options(0.9 * error))};  // which is proven to be near enough
  best->second.seconds = seconds_of_mesh(subject, options(best->first));
  return best->second;
}

bool compare(const Subject& subject, double deflection) {
  const Measured occt = measure_occt(subject, deflection);
  const Measured ours = measure_tessera(subject, occt.error, false),
                 fewest = measure_tessera(subject, occt.error, true);
  std::printf("%-38s %9.1e | %8zu %9.2e %9.3f | %8zu %9.2e %9.2e %9.5f", subject.name.c_str(), deflection,
              occt.triangles, occt.error, 1e3 * occt.seconds, ours.triangles, ours.error, ours.bound,
              1e3 * ours.seconds);
  for (const Measured* const one : {&ours, &fewest})
    std::printf(" | %7.0f %9.2f", occt.seconds / one->seconds,
                static_cast<double>(one->triangles) / static_cast<double>(occt.triangles));
  std::printf("\n");
  std::fflush(stdout);
  char deflected[32];
  std::snprintf(deflected, sizeof deflected, "%.2g", deflection);
  add_result({"meshes of equal error: " + subject.name, "OpenCASCADE " OCC_VERSION_COMPLETE,
              std::string("BRepMesh_IncrementalMesh, deflection ") + deflected,
              static_cast<double>(occt.triangles) / occt.seconds, "certified mesh, by its time",
              occt.seconds / ours.seconds});
  const auto keeps = [&](const Measured& one) { return one.error <= one.bound && one.error <= occt.error; };
  if (keeps(ours) && keeps(fewest)) return true;
  std::fputs("occt_mesh: a bound is exceeded, or the mesh is further away than OpenCASCADE's\n", stderr);
  return false;
}

int run() {
  const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
  std::printf("%-38s %9s | %-28s | %-38s | %-17s | %s\n", "", "", "OpenCASCADE", "Tessera", "over the other's",
              "the same of the fewest");
  std::printf("%-38s %9s | %8s %9s %9s | %8s %9s %9s %9s | %7s %9s | %7s %9s\n", "surface", "deflection", "triangles",
              "error", "ms", "triangles", "error", "bound", "ms", "faster", "triangles", "faster", "triangles");
  bool good = true;
  const Subject subjects[] = {spline_subject(40), patches_subject("400 bicubic faces", test::wavy_field(20, 20)),
                              patches_subject("closed body of 6 bicubic faces", test::closed_body()),
                              patches_subject("sphere of 8 rational octants", test::sphere())};
  for (const Subject& subject : subjects)
    for (const double relative : {3e-3, 1e-3, 3e-4, 1e-4})
      good = compare(subject, relative * subject.set.box().diagonal()) && good;
  return good ? 0 : 1;
}

}  // namespace
}  // namespace tessera::bench

int main() { return tessera::bench::run(); }
