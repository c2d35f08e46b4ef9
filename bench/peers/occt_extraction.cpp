// Bezier extraction of a bicubic B-spline surface of 200 x 200 spans. Compares Tessera's to_bezier, alone and with the
// packing into blocks, on one thread and on all, with OpenCASCADE's single-threaded
// GeomConvert_BSplineSurfaceToBezierSurface. They take turns. Checks first that the control points of all patches agree
// with OpenCASCADE's to 1e-12 of the surface's size, and that the blocks hold them up to the rounding of float.

#include <tbb/task_arena.h>
#include <GeomConvert_BSplineSurfaceToBezierSurface.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_BezierSurface.hxx>
#include <Standard_Version.hxx>
#include <TColGeom_Array2OfBezierSurface.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColgp_Array2OfPnt.hxx>

#include <cmath>
#include <cstdio>

#include "base/impl_access.h"
#include "block/patch_set_impl.h"
#include "convert/wavy_surface.h"
#include "peers/interleaved.h"
#include "peers/results.h"
#include "support/synthetic_sets.h"
#include "tessera/convert.h"
#include "tessera/model.h"

namespace tessera::bench { namespace {

constexpr int spans = 200, degree = 3, rounds = 20;

/// OpenCASCADE counts from 1, and has each knot once, with its multiplicity.
Handle(Geom_BSplineSurface) occt_surface(const BSplineSurface& surface) {
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

void occt_patches(const Handle(Geom_BSplineSurface) & surface, TColGeom_Array2OfBezierSurface& patches) {
  GeomConvert_BSplineSurfaceToBezierSurface convert(surface);
  convert.Patches(patches);
}

double size_of(const BSplineSurface& surface) {
  Box3 box;
  for (const Vec3& p : surface.points()) box.extend(p);
  return box.diagonal();
}

/// The largest distance of a control point of a patch from OpenCASCADE's.
double distance(const PatchGrid& grid, const TColGeom_Array2OfBezierSurface& patches) {
  double largest = 0;
  for (int a = 0; a < spans; ++a)
    for (int b = 0; b < spans; ++b) {
      const BezierPatch& patch = grid.patch(static_cast<std::size_t>(a), static_cast<std::size_t>(b));
      const Handle(Geom_BezierSurface)& other = patches.Value(a + 1, b + 1);
      for (int i = 0; i <= degree; ++i)
        for (int j = 0; j <= degree; ++j) {
          const gp_Pnt q = other->Pole(i + 1, j + 1);
          const Vec3& p = patch.point(i, j);
          largest = std::fmax(largest, max_abs(p - Vec3{q.X(), q.Y(), q.Z()}));
        }
    }
  return largest;
}

/// The largest distance of a coefficient in the set's blocks from its patch's control point.
double distance(const PatchSet& set) {
  const PatchSet::Impl& inside = impl_of(set);
  const BlockGroup& group = inside.groups.front();
  double largest = 0;
  for (std::size_t k = 0; k < set.patch_count(); ++k) {
    const auto [block, lane] = set.slot(k);
    const float* values = &inside.f32.bernstein[group.first_value + block * group.block_values + lane];
    for (const Vec3& p : set.patch(k).points()) {
      const Vec3 relative = p - set.origin();
      for (const double x : {relative.x, relative.y, relative.z}) {
        largest = std::fmax(largest, std::abs(x - double{*values}));
        values += PatchSet::lanes;
      }
    }
  }
  return largest;
}

int run() {
  const BSplineSurface surface = test::value_of(wavy_surface(spans, degree, false));
  const Handle(Geom_BSplineSurface) occt = occt_surface(surface);
  const double size = size_of(surface);

  TColGeom_Array2OfBezierSurface patches(1, spans, 1, spans);
  occt_patches(occt, patches);
  const PatchGrid grid = test::value_of(to_bezier(surface));
  const PatchSet set = test::value_of(make_patch_set({&grid, 1}));
  const double apart = distance(grid, patches), rounding = distance(set);
  std::printf("control points agree to %.1e of the size; blocks hold them to %.1e of it\n", apart / size,
              rounding / size);
  if (!(apart <= 1e-12 * size) || !(rounding <= 0x1p-24 * size) || impl_of(set).groups.size() != 1) {
    std::fputs("occt_extraction: the conversions do not agree\n", stderr);
    return 1;
  }

  const auto make_patches = [&] { (void)test::value_of(to_bezier(surface)); };
  const auto make_blocks = [&] { (void)test::value_of(make_patch_set(test::value_of(to_bezier(surface)))); };
  tbb::task_arena alone(1);
  const auto with_occt = [&] { return seconds_of([&] { occt_patches(occt, patches); }); };
  const auto to_patches_alone = [&] { return seconds_of([&] { alone.execute(make_patches); }); };
  const auto to_blocks_alone = [&] { return seconds_of([&] { alone.execute(make_blocks); }); };
  const auto to_patches = [&] { return wall_seconds_of(make_patches); };
  const auto to_blocks = [&] { return wall_seconds_of(make_blocks); };
  const auto seconds = best_interleaved(rounds, {with_occt, to_patches_alone, to_blocks_alone, to_patches, to_blocks});
  const char* names[] = {"OpenCASCADE, to patches", "Tessera, to patches, one thread", "Tessera, to blocks, one thread",
                         "Tessera, to patches", "Tessera, to blocks"};
  for (std::size_t k = 0; k < seconds.size(); ++k)
    std::printf("%-31s %7.2f million patches/s  %6.2f times OpenCASCADE\n", names[k], 1e-6 * spans * spans / seconds[k],
                seconds[0] / seconds[k]);
  for (const std::size_t k : {1, 2})
    add_result({"Bezier extraction, 200 x 200 spans", "OpenCASCADE " OCC_VERSION_COMPLETE,
                "GeomConvert_BSplineSurfaceToBezierSurface", spans * spans / seconds[0], names[k] + 9,
                seconds[0] / seconds[k], k == 1});
  return 0;
}

}}  // namespace tessera::bench

int main() { return tessera::bench::run(); }
