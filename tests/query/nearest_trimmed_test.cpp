// Nearest points of trimmed faces: they are kept, and no kept point of many is nearer.

#include <gtest/gtest.h>

#include "support/outlines.h"
#include "support/trimmed_proof.h"
#include "tessera/model.h"
#include "tessera/nearest_points.h"

namespace tessera::test { namespace {

struct TrimmedNearest {
  std::size_t points = 0, certified = 0, cut_away = 0, beaten = 0, on_border = 0;
  double worst = 0;
};

/// Finds kept points of a face that are nearer than `found`: points of its loops, points all over it, and points beside
/// the one that was found.
class NearerKeptPoint {
 public:
  NearerKeptPoint(const TrimmedCase& of, std::uint64_t seed) : of_(of), random_(seed) {
    for (const OutlinedFace& face : of.faces) {
      const Domain domain = face.grid->domain();
      for (const Outline& outline : face.outlines)
        for (int k = 0; k < 400; ++k) {
          const OutlinePlace place = outline.draw(random_);
          // A little inside, as far as the formula says.
          for (const Real side : {1e-9L, -1e-9L})
            add(face, double(place.u + side * place.normal_u), double(place.v + side * place.normal_v));
        }
      for (int k = 0; k < 2000; ++k)
        add(face, uniform(random_, domain.u0, domain.u1), uniform(random_, domain.v0, domain.v1));
    }
  }

  double beaten_by(const Vec3& point, const NearestPoint& found) {
    double nearest = found.distance;
    for (const Vec3& p : kept_) nearest = std::min(nearest, length(p - point));
    const OutlinedFace& face = of_.faces[of_.face[found.patch]];
    for (int k = 0; k < 100; ++k) {
      const double reach = rays::power(random_, 1e-8, 1e-1);
      const double u = found.u + reach * uniform(random_, -1, 1), v = found.v + reach * uniform(random_, -1, 1);
      if (is_kept(face, u, v)) nearest = std::min(nearest, length(face.grid->evaluate_jet(u, v)->position - point));
    }
    return found.distance - nearest;
  }
  static bool is_kept(const OutlinedFace& face, double u, double v) {
    return face.grid->domain().contains(u, v) && face.depth(u, v) > face.margin();
  }

 private:
  void add(const OutlinedFace& face, double u, double v) {
    if (is_kept(face, u, v)) kept_.push_back(face.grid->evaluate_jet(u, v)->position);
  }
  const TrimmedCase& of_;
  Random random_;
  std::vector<Vec3> kept_;
};

void tally(const TrimmedCase& of, int count, TrimmedNearest& out) {
  Random random(5);
  const PointScene scene = value_of(PointScene::make(*of.set));
  NearerKeptPoint reference(of, 6);
  for (int k = 0; k < count; ++k) {
    const Ray ray = draw_ray(of, random);
    const Vec3 aimed = ray.origin + uniform(random, 0.2, 1.8) * ray.direction;
    const Vec3 point =
        k % 3 == 0 ? aimed : aimed + of.size * rays::power(random, 1e-9, 0.3) * rays::unit_vector(random);
    const NearestPoint found = scene.nearest(point);
    ASSERT_EQ(found.kind, NearestKind::found);
    ++out.points, out.certified += found.flags.certified, out.on_border += found.flags.border;
    const OutlinedFace& face = of.faces[of.face[found.patch]];
    out.cut_away += !(face.depth(found.u, found.v) > -1e-9L);
    const double beaten = reference.beaten_by(point, found);
    out.worst = std::max(out.worst, beaten / of.size);
    out.beaten += found.flags.certified && beaten > 2e-13 * of.size;
  }
}

TEST(NearestTrimmed, NoKeptPointIsNearer) {
  for (const TrimmedClass& one : trimmed_classes()) {
    SCOPED_TRACE(one.name);
    TrimmedNearest out;
    for (const TrimmedCase& of : one.cases) tally(of, int(240 / one.cases.size()) + 1, out);
    EXPECT_EQ(out.cut_away, 0u);
    EXPECT_EQ(out.beaten, 0u) << out.worst;
    EXPECT_GE(double(out.certified), 0.99 * double(out.points));
    EXPECT_GT(out.on_border, out.points / 20);
  }
}

/// A target of rings around a disc, and points at its middle, from which each circle is equally far all around. The
/// circles must not use up the work before the disc is looked at.
TEST(NearestTrimmed, CirclesDoNotHideTheirMiddle) {
  const Vec3 corners[] = {{0, 0, 0}, {0, 10, 0}, {10, 0, 0}, {10, 10, 0}};
  std::vector<TrimLoop> loops;
  for (const double radius : {4.8, 4.0, 3.0, 2.0, 1.0})
    loops.push_back(round_outline(0.5, 0.5, radius / 10, false).loop);
  Model model;
  model.surfaces.push_back({.name = std::string("target"),
                            .surface = value_of(BezierPatch::polynomial(1, 1, corners)),
                            .trims = std::move(loops)});
  const PointScene scene = value_of(PointScene::make(model));
  for (const Vec3& point : {Vec3{5, 5, 0}, {5, 5, 0.25}, {5, 5 + 1e-9, 0}, {5, 4.75, 1e-12}}) {
    const NearestPoint found = scene.nearest(point);
    EXPECT_NEAR(found.distance, point.z, 1e-15);
    EXPECT_TRUE(found.flags.certified) << point.y << ' ' << point.z;
  }
}

}}  // namespace tessera::test
