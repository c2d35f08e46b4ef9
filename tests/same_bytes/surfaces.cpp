#include <tessera/bezier_operations.h>
#include <tessera/convert.h>
#include <tessera/local_geometry.h>

#include "families.h"
#include "hash.h"
#include "models.h"

namespace {

std::uint64_t jets(tessera::Isa) {
  Hash hash;
  Seeded seeded(1);
  for (const tessera::Surface& surface : some_surfaces()) {
    const tessera::Domain domain = tessera::domain(surface);
    for (int k = 0; k < 200; ++k) {
      const double u = seeded.between(domain.u0, domain.u1), v = seeded.between(domain.v0, domain.v1);
      hash.add(value_of(tessera::evaluate_jet(surface, u, v)));
    }
  }
  return hash.value();
}

std::uint64_t bezier(tessera::Isa) {
  Hash hash;
  for (const tessera::Surface& surface : some_surfaces()) {
    const tessera::PatchGrid grid = value_of(tessera::to_bezier(surface));
    hash.add(grid.fit_error().distance);
    for (const tessera::BezierPatch& patch : grid.patches()) {
      for (const tessera::Vec3& point : patch.points()) hash.add(point);
      for (const double weight : patch.weights()) hash.add(weight);
    }
  }
  return hash.value();
}

std::uint64_t geometry(tessera::Isa) {
  Hash hash;
  for (const tessera::BezierPatch& patch : some_patches()) {
    for (int i = 0; i <= 8; ++i)
      for (int j = 0; j <= 8; ++j) {
        const tessera::LocalGeometry at = tessera::local_geometry(patch, i / 8.0, j / 8.0);
        hash.add(at.normal.direction);
        for (const double x : {at.e, at.f, at.g, at.l, at.m, at.n, at.gaussian, at.mean}) hash.add(x);
        hash.add(at.first.direction);
        hash.add(at.second.direction);
      }
    const tessera::NetReport report = value_of(tessera::measure_net(patch));
    for (const double x : {report.largest_cosine, report.dot_bound, report.volume_bound}) hash.add(x);
  }
  return hash.value();
}

std::uint64_t joins(tessera::Isa) {
  Hash hash;
  const auto patches = some_patches();
  for (std::size_t k = 0; k + 1 < patches.size(); ++k) {
    const tessera::JoinedPatch p{patches[k], tessera::Side::u1}, q{patches[k + 1], tessera::Side::u0};
    const tessera::JoinReport report = value_of(tessera::measure_join(p, q));
    for (const double x : {report.position_gap, report.normal_angle, report.derivative_gap}) hash.add(x);
    const auto made = tessera::make_join(p, q);
    if (made)
      for (const tessera::Vec3& point : made->points()) hash.add(point);
  }
  return hash.value();
}

}  // namespace

std::vector<Family> surface_families() {
  return {{"jets", jets}, {"bezier", bezier}, {"geometry", geometry}, {"joins", joins}};
}
