// A plan follows a camera: each frame keeps the pixels that are proven, with and without edits.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <vector>

#include "support/synthetic_sets.h"
#include "tess/bounds/graded_segments.h"
#include "tess/followed_mesh.h"
#include "tess/seen_pixels.h"
#include "tessera/tessellation.h"

namespace tessera::test { namespace {

/// A camera on a circle about a set, which looks at its middle.
View orbit(const PatchSet& set, double angle, double distance = 1.2) {
  const double size = set.box().diagonal();
  View view{.eye = set.box().centre() + distance * size * Vec3{std::cos(angle), std::sin(angle), 0.5},
            .target = set.box().centre()};
  view.width = 640, view.height = 400;
  return view;
}

/// Follows the camera, and the edits that the set has had.
MeshChange follow(Animated& body, const View& view) {
  const Status status = body.plan.set_view(view);
  EXPECT_TRUE(status.ok()) << status.message();
  const MeshChange change = good(body.plan.update(body.set, body.mesh.views()));
  if (change.topology) body.mesh = mesh_of(body.set, body.plan);
  return change;
}

TEST(MovingView, EachFrameKeepsItsPixels) {
  for (const TessellationOptions& options :
       {TessellationOptions{.pixels = PixelTolerance{0.5, {}}},
        {.tolerance = 0.05, .angle = 0.3, .pixels = PixelTolerance{0.5, {}}},
        {.pixels = PixelTolerance{0.5, {}}, .joining = {.crease_angle = 0.5, .share_vertices = true}, .headroom = 0.3}})
    for (const bool is_body : {false, true}) {
      TessellationOptions at = options;
      const std::vector<BezierPatch> patches = is_body ? closed_body() : wavy_field(12, 12);
      at.pixels->view = orbit(set_of(patches), 0);
      Animated body(patches, at);
      std::size_t triangles = 0, anew = 0, changes = 0;
      for (int frame = 1; frame <= 25; ++frame) {
        const View view = orbit(body.set, 0.03 * frame, 1.3 - 0.03 * frame);
        changes += follow(body, view).topology;
        body.expect_as_anew();
        EXPECT_LE(body.plan.pixels(), 0.5 * (1 + 1e-6));
        if (frame % 8 != 0) continue;
        at.pixels->view = view;
        const Tessellation fresh = good(Tessellation::make(body.set, at));
        triangles += body.plan.capacity().triangles;
        anew += fresh.capacity().triangles;
        EXPECT_EQ(fresh.patches_beyond_tolerance().size(), body.plan.patches_beyond_tolerance().size());
      }
      EXPECT_GT(changes, 0u);
      EXPECT_LE(triangles, 1.25 * static_cast<double>(anew));  // spare
      EXPECT_TRUE(!is_body || good(check(body.mesh)).closed());
    }
}

TEST(MovingView, MeasuredPixelsAreWithinTheirBounds) {
  Random random(2);
  TessellationOptions options{.pixels = PixelTolerance{1, {}}, .parameters = VertexParameters::patch};
  const std::vector<BezierPatch> patches = mixed_patches(5, 40);
  for (const View& first : views_of(set_of(patches))) {
    options.pixels->view = first;
    const PatchSet set = set_of(patches);
    if (!Tessellation::make(set, options)) continue;  // patches that all but touch the eye
    Animated body(patches, options);
    for (const View& view : views_of(set)) {
      if (!body.plan.set_view(view).ok()) ADD_FAILURE();
      const auto change = body.plan.update(body.set, body.mesh.views());
      if (!change) continue;  // as above
      body.mesh = mesh_of(body.set, body.plan);
      EXPECT_LE(pixels_over_bound(body.set, body.plan, body.mesh, view, random).share, 1);
    }
  }
}

TEST(MovingView, EditsAndViewsTogether) {
  TessellationOptions options{.pixels = PixelTolerance{0.5, {}}};
  options.pixels->view = orbit(set_of(wavy_field(8, 8)), 0);
  Animated field(wavy_field(8, 8), options), apart(wavy_field(8, 8), options);
  for (int frame = 1; frame <= 20; ++frame) {
    const View view = orbit(field.set, 0.05 * frame);
    const Edits edits = swollen(field.set, frame % 3 == 0 ? 1 : 7, frame % 2 == 0 ? 0.05 : -0.04);
    ASSERT_TRUE(field.plan.set_view(view).ok());
    field.run(edits);
    field.expect_as_anew();
    EXPECT_LE(field.plan.pixels(), 0.5 * (1 + 1e-6));
    // One after the other leads to the same set, and keeps the same.
    apart.run(edits);
    follow(apart, view);
    EXPECT_LE(apart.plan.pixels(), 0.5 * (1 + 1e-6));
    EXPECT_EQ(apart.set.patch(3).points()[5], field.set.patch(3).points()[5]);
  }
}

TEST(MovingView, TheViewBeforeHoldsUntilTheUpdate) {
  TessellationOptions options{.pixels = PixelTolerance{0.5, {}}};
  const PatchSet like = set_of(wavy_field(8, 8));
  options.pixels->view = orbit(like, 0, 3);
  Animated field(wavy_field(8, 8), options);
  const double pixels = field.plan.pixels();
  const std::size_t triangles = field.plan.capacity().triangles;
  ASSERT_TRUE(field.plan.set_view(orbit(like, 1, 0.6)).ok());
  EXPECT_EQ(field.plan.pixels(), pixels);
  EXPECT_EQ(field.plan.capacity().triangles, triangles);
  field.expect_as_anew();
  // A cancelled update leaves the view to the next.
  const std::atomic<bool> cancel = true;
  const auto cancelled = field.plan.update(field.set, field.mesh.views(), {.cancel = &cancel});
  EXPECT_EQ(cancelled.status().code(), StatusCode::cancelled);
  EXPECT_EQ(field.plan.capacity().triangles, triangles);
  EXPECT_TRUE(good(field.plan.update(field.set, field.mesh.views())).topology);
  EXPECT_GT(field.plan.capacity().triangles, 2 * triangles);
  field.mesh = mesh_of(field.set, field.plan);
  // An unchanged view changes nothing; one that sees nothing takes two triangles a patch.
  EXPECT_FALSE(follow(field, orbit(like, 1, 0.6)).topology);
  View away = orbit(like, 1);
  away.target = away.eye + (away.eye - away.target);
  EXPECT_TRUE(follow(field, away).topology);
  EXPECT_EQ(field.plan.capacity().triangles, 2u * 64);
  EXPECT_EQ(seen_bound(field.plan), 0);
  EXPECT_GT(field.plan.bound(), 0.01);
}

TEST(MovingView, BoundsOfSeenPatchesApart) {
  const PatchSet set = set_of(wavy_field(16, 4));
  const View view{.eye = {-3, 2, 2}, .target = {-1, 2, 0.5}, .field_of_view = 1, .near_distance = 0.01};
  const Tessellation plan = good(Tessellation::make(set, {.pixels = PixelTolerance{0.5, view}}));
  double seen = 0;
  std::size_t unseen = 0;
  for (std::size_t k = 0; k < set.patch_count(); ++k)
    if (plan.pixel_bounds()[k] > 0)
      seen = std::max(seen, double(plan.bounds()[k]));
    else
      ++unseen;
  EXPECT_GT(unseen, 0u);
  EXPECT_EQ(seen_bound(plan), seen);
  EXPECT_LT(4 * seen_bound(plan), plan.bound());
  const Tessellation by_distance = good(Tessellation::make(set, {.tolerance = 0.01}));
  EXPECT_EQ(seen_bound(by_distance), by_distance.bound());
}

TEST(MovingView, WrongOnesAreRefused) {
  TessellationOptions options{.pixels = PixelTolerance{0.5, {}}};
  const PatchSet like = set_of(closed_body());
  const View sound = orbit(like, 0);
  options.pixels->view = sound;
  Animated body(closed_body(), options);
  const auto refused = [&](auto change, const std::string& message) {
    View view = sound;
    change(view);
    const Status status = body.plan.set_view(view);
    EXPECT_EQ(status.code(), StatusCode::invalid_argument);
    EXPECT_NE(status.message().find(message), std::string::npos) << status.message();
  };
  refused([](View& v) { v.eye.x = std::nan(""); }, "must be finite");
  refused([](View& v) { v.target = v.eye; }, "the same point");
  refused([](View& v) { v.width = 0; }, "pixels, each must be from 1 to");
  EXPECT_FALSE(good(body.plan.update(body.set, body.mesh.views())).topology);
  for (const TessellationOptions& others : {TessellationOptions{.tolerance = 0.01}, {.rates = UniformRates{4, 4}}}) {
    Tessellation plan = good(Tessellation::make(like, others));
    const Status status = plan.set_view(sound);
    EXPECT_EQ(status.code(), StatusCode::invalid_argument);
    EXPECT_NE(status.message().find("no tolerance in pixels"), std::string::npos);
  }
}

/// Limits of a distance over quarters that differ.
ChordBound random_chord(Random& random) {
  ChordBound::Pieces pieces;
  for (std::size_t quarter = 5; quarter < 9; ++quarter)
    pieces[quarter] = {.uu = std::exp(uniform(random, -2, 5)),
                       .uv = random() % 3 == 0 ? 0 : std::exp(uniform(random, -3, 3)),
                       .vv = std::exp(uniform(random, -2, 5))};
  const auto join = [&](std::size_t to, std::size_t a, std::size_t b) {
    pieces[to] = {.uu = std::max(pieces[a].uu, pieces[b].uu),
                  .uv = std::max(pieces[a].uv, pieces[b].uv),
                  .vv = std::max(pieces[a].vv, pieces[b].vv)};
  };
  join(1, 5, 6), join(2, 7, 8), join(3, 5, 7), join(4, 6, 8), join(0, 1, 2);
  return ChordBound(pieces);
}

/// The fewest cells of all divisions, by trial, or of those with halves along both parameters or none.
double fewest_by_trial(const CellLimits& limits, int most, bool mixed) {
  double fewest = std::numeric_limits<double>::infinity();
  std::vector<Segments> all;
  for (int n = 1; n <= most; ++n) {
    all.push_back(n);
    for (int lower = 1; lower < n; ++lower) all.push_back(Segments::halves(lower, n - lower));
  }
  for (const Segments& u : all)
    for (const Segments& v : all)
      if (double(u.rate()) * v.rate() < fewest && (mixed || u.parts_halves() == v.parts_halves()) &&
          limits.keeps({u, v}))
        fewest = double(u.rate()) * v.rate();
  return fewest;
}

TEST(MovingView, NoSegmentsHaveFewerCellsThanTheBoundFromBelow) {
  Random random(3);
  int tight = 0, graded = 0;
  constexpr int count = 200, most = 14;  // segments along a parameter
  for (int k = 0; k < count; ++k) {
    const ChordBound picture = random_chord(random), chord = random_chord(random);
    CellLimits limits{.picture = &picture, .pixels = std::exp(uniform(random, -1, 1))};
    if (k % 3 == 0) limits.chord = &chord, limits.distance = 0.5;
    const double fewest = fewest_by_trial(limits, most, true);
    if (!(fewest <= most)) continue;  // others may have more segments along one parameter
    EXPECT_LE(LeastRates(limits).cells(), fewest);
    EXPECT_TRUE(may_have_fewer(limits, fewest + 1));
    tight += !may_have_fewer(limits, fewest);
    const Rates uniform_rates = *cheapest(limits, 100);
    const double uniform_cells = double(uniform_rates.u) * uniform_rates.v;
    const auto found = graded_segments(limits, uniform_rates);
    graded += found.has_value();
    if (uniform_cells < 6) continue;  // too few to look for better ones
    const double cells = found ? found->cells() : uniform_cells;
    EXPECT_GE(cells, fewest);
    EXPECT_LE(cells, fewest_by_trial(limits, most, false) / 0.97);
    EXPECT_TRUE(!found || limits.keeps(*found));
  }
  EXPECT_GT(tight, count / 10);
  EXPECT_GT(graded, count / 20);
}

}}  // namespace tessera::test
