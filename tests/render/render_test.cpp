// Small pictures: the model is in the middle, casts a shadow, and is the same for any threads, scale and place.

#include "render/render.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "support/synthetic_sets.h"

namespace tessera::render { namespace {

using test::placed;
using test::value_of;

struct Drawn {
  PatchSet set;
  RayScene scene;
  explicit Drawn(const std::vector<BezierPatch>& patches)
      : set(value_of(PatchSet::make(patches))), scene(value_of(RayScene::make(set))) {}
  Image image(const Settings& settings) const { return value_of(render(scene, set.box(), settings)); }
};

Settings small(Shade shade = Shade::lambert) {
  Settings settings;
  settings.width = 60, settings.height = 40, settings.samples = 2, settings.shade = shade;
  return settings;
}

struct Rgb {
  int r, g, b;
  int sum() const { return r + g + b; }
};
Rgb pixel(const Image& image, int x, int y) {
  const std::uint8_t* p = &image.rgb[3 * static_cast<std::size_t>(y * image.width + x)];
  return {p[0], p[1], p[2]};
}

int darkest(const Image& image) {
  int least = 3 * 255;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) least = std::min(least, pixel(image, x, y).sum());
  }
  return least;
}

TEST(Render, TheModelFillsThePictureAndNoMore) {
  const Drawn ball(test::sphere());
  for (const auto& [width, height] : {std::pair{60, 40}, std::pair{40, 60}, std::pair{40, 40}}) {
    Settings settings = small(Shade::patch);
    settings.width = width, settings.height = height;
    const Image image = ball.image(settings);
    const Rgb background = pixel(image, 0, 0);
    const auto is_model = [&](int x, int y) { return std::abs(pixel(image, x, y).sum() - background.sum()) > 30; };
    int covered = 0;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        covered += is_model(x, y);
        if (x == 0 || y == 0 || x == width - 1 || y == height - 1) {
          EXPECT_FALSE(is_model(x, y)) << x << ' ' << y;
        }
      }
    }
    EXPECT_TRUE(is_model(width / 2, height / 2));
    EXPECT_GT(covered, width * height / 10);
  }
}

TEST(Render, NormalsPointWhereTheyShould) {
  // From straight above, the middle of the ball looks up: (0.5, 0.5, 1) on the screen, or down if the patch is turned.
  const Drawn ball(test::sphere());
  Settings settings = small(Shade::normals);
  settings.camera = Camera{{0.02, 0.01, 6}, {0.02, 0.01, 0}, 40, {0, 1, 0}};
  const Rgb middle = pixel(ball.image(settings), 30, 20);
  EXPECT_NEAR(middle.r, 128, 12);
  EXPECT_NEAR(middle.g, 128, 12);
  EXPECT_TRUE(middle.b > 250 || middle.b < 5);
}

TEST(Render, ParametersAreShown) {
  const Drawn square(
      {value_of(BezierPatch::polynomial(1, 1, std::vector<Vec3>{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}}))});
  Settings settings = small(Shade::uv);
  settings.camera = Camera{{0.5, 0.5, 3}, {0.5, 0.5, 0}, 20, {0, 1, 0}};
  const Image image = square.image(settings);
  const Rgb low = pixel(image, 17, 33), high_u = pixel(image, 42, 33), high_v = pixel(image, 17, 7);
  EXPECT_GT(high_u.r, low.r + 100);
  EXPECT_NEAR(high_u.g, low.g, 60);
  EXPECT_GT(high_v.g, low.g + 100);
  EXPECT_NEAR(high_v.r, low.r, 60);
}

TEST(Render, CurvatureAndCostAreShown) {
  const auto middle_of = [](const std::vector<BezierPatch>& patches) {
    Settings settings = small(Shade::curvature);
    settings.camera = Camera{{0.45, 0.55, 4}, {0.45, 0.55, 0}, 20, {0, 1, 0}};
    return pixel(Drawn(patches).image(settings), 30, 20);
  };
  const auto over_square = [](double middle, double end) {  // end, middle, end along u; 0, middle, 0 along v
    std::vector<Vec3> points;
    for (const double u : {0.0, 0.5, 1.0}) {
      for (const double v : {0.0, 0.5, 1.0}) points.push_back({u, v, (u == 0.5 ? 0 : end) + (v == 0.5 ? middle : 0)});
    }
    return std::vector<BezierPatch>{value_of(BezierPatch::polynomial(2, 2, points))};
  };
  const Rgb dome = middle_of(over_square(1, -1)), saddle = middle_of(over_square(1, 1)),
            trough = middle_of(over_square(0, 1));
  EXPECT_GT(dome.r, dome.b + 30);
  EXPECT_GT(saddle.b, saddle.r + 30);
  EXPECT_NEAR(trough.r, trough.b, 12);

  // Rays that touch the ball cost more than those that hit it at a right angle; those that pass it at a distance cost
  // nothing.
  const Image cost = Drawn(test::sphere()).image(small(Shade::steps));
  EXPECT_GT(pixel(cost, 30, 20).b, pixel(cost, 30, 20).r);
  const Rgb nothing = pixel(cost, 0, 0);
  EXPECT_GT(std::min({nothing.r, nothing.g, nothing.b}), 230);
  int warmest = 0;
  for (int y = 0; y < cost.height; ++y) {
    for (int x = 0; x < cost.width; ++x) {
      if (pixel(cost, x, y).b < 200) warmest = std::max(warmest, pixel(cost, x, y).r);
    }
  }
  EXPECT_GT(warmest, pixel(cost, 30, 20).r + 10);
}

TEST(Render, TheModelCastsAShadow) {
  // A plate above the floor: a camera that looks at the floor under it sees light without the plate, shadow with it.
  const std::vector<Vec3> low{{0, 0, 0}, {0, 0.01, 0}, {0.01, 0, 0}, {0.01, 0.01, 0}};
  const std::vector<Vec3> high{{-4, -4, 2}, {-4, 4, 2}, {4, -4, 2}, {4, 4, 2}};
  const BezierPatch speck = value_of(BezierPatch::polynomial(1, 1, low)),
                    plate = value_of(BezierPatch::polynomial(1, 1, high));
  const Drawn lit({speck}), shaded({speck, plate});
  Settings settings = small();
  settings.camera = Camera{{5, -5, 1}, {1.5, -1.5, 0}, 10, {0, 0, 1}};
  const Rgb light = pixel(value_of(render(lit.scene, shaded.set.box(), settings)), 30, 20);
  const Rgb dark = pixel(value_of(render(shaded.scene, shaded.set.box(), settings)), 30, 20);
  EXPECT_LT(dark.sum(), light.sum() / 2);
}

TEST(Render, ShadedPicturesHaveSkyFloorAndShadow) {
  const Drawn ball(test::sphere());
  const Image image = ball.image(small());
  const Rgb sky = pixel(image, 2, 0), floor = pixel(image, 2, 39);
  EXPECT_GT(sky.b, sky.r);      // blue above
  EXPECT_GT(floor.r, floor.b);  // warm below
  EXPECT_LT(darkest(image), floor.sum() / 2);
}

TEST(Render, SameBytesForAnyNumberOfThreads) {
  const tbb::global_control four(tbb::global_control::max_allowed_parallelism, 4);
  const Drawn body(test::closed_body());
  for (const Shade shade : {Shade::lambert, Shade::normals, Shade::uv, Shade::patch}) {
    std::vector<Image> images;
    for (const int threads : {1, 2, 4}) {
      tbb::task_arena(threads).execute([&] { images.push_back(body.image(small(shade))); });
    }
    EXPECT_EQ(images[0].rgb, images[1].rgb);
    EXPECT_EQ(images[0].rgb, images[2].rgb);
  }
}

TEST(Render, ScaleAndPlaceDoNotMatter) {
  const Image expected = Drawn(test::closed_body()).image(small());
  for (const auto& [scale, shift] :
       {std::pair{1e-6, Vec3{}}, std::pair{1e6, Vec3{}}, std::pair{10.0, Vec3{1e6, -1e6, 1e6}}}) {
    const Image image = Drawn(placed(test::closed_body(), scale, shift)).image(small());
    std::size_t differing = 0;
    for (std::size_t k = 0; k < image.rgb.size(); ++k) differing += std::abs(image.rgb[k] - expected.rgb[k]) > 12;
    EXPECT_LT(differing, image.rgb.size() / 50) << scale;  // rounding moves a sample across an edge here and there
  }
}

TEST(Render, AnyAxisMayPointUp) {
  // The model is turned so that its z axis becomes `up`: the picture is unchanged.
  std::vector<Image> images;
  for (const Up up : {Up::x, Up::y, Up::z}) {
    std::vector<BezierPatch> turned;
    for (const BezierPatch& patch : test::closed_body()) {
      std::vector<Vec3> points;
      for (int i = 0; i <= patch.degree_u(); ++i)
        for (int j = 0; j <= patch.degree_v(); ++j) points.push_back(from_z_up(patch.point(i, j), up));
      turned.push_back(value_of(BezierPatch::polynomial(patch.degree_u(), patch.degree_v(), points)));
    }
    Settings settings = small();
    settings.up = up;
    settings.samples = 8;  // random directions differ with the axes
    images.push_back(Drawn(turned).image(settings));
  }
  for (const Image& image : {images[0], images[1]}) {
    std::size_t differing = 0;
    for (std::size_t k = 0; k < image.rgb.size(); ++k) differing += std::abs(image.rgb[k] - images[2].rgb[k]) > 24;
    EXPECT_LT(differing, image.rgb.size() / 100);
  }
}

TEST(Render, SimpleLightKeepsSunAndShadow) {
  Settings settings = small();
  settings.simple_light = true;
  const Image image = Drawn(test::sphere()).image(settings);
  EXPECT_LT(darkest(image), pixel(image, 2, 39).sum() / 2);
}

TEST(Render, BadSettings) {
  const Drawn ball(test::sphere());
  const auto code = [&](auto&& spoil) {
    Settings settings = small();
    spoil(settings);
    return render(ball.scene, ball.set.box(), settings).status().code();
  };
  EXPECT_EQ(code([](Settings& s) { s.width = 0; }), StatusCode::invalid_argument);
  EXPECT_EQ(code([](Settings& s) { s.height = -1; }), StatusCode::invalid_argument);
  EXPECT_EQ(code([](Settings& s) { s.width = 32769; }), StatusCode::invalid_argument);
  EXPECT_EQ(code([](Settings& s) { s.samples = 0; }), StatusCode::invalid_argument);
  EXPECT_EQ(code([](Settings& s) { s.samples = 17; }), StatusCode::invalid_argument);
  EXPECT_EQ(code([](Settings& s) {
              s.camera = Camera{{1, 2, 3}, {1, 2, 3}, 40, {0, 0, 1}};
            }),
            StatusCode::invalid_argument);
  EXPECT_EQ(code([](Settings& s) { s.camera = Camera{{1, 2, 3}, {}, 180, {0, 0, 1}}; }), StatusCode::invalid_argument);
  EXPECT_EQ(code([](Settings& s) { s.camera = Camera{{1, NAN, 3}, {}, 40, {0, 0, 1}}; }), StatusCode::invalid_argument);
  EXPECT_EQ(code([](Settings& s) {
              s.camera = Camera{{1e19, 2, 3}, {}, 40, {0, 0, 1}};
            }),
            StatusCode::invalid_argument);
  EXPECT_EQ(code([](Settings& s) {
              s.camera = Camera{{}, {1, -1e19, 3}, 40, {0, 0, 1}};
            }),
            StatusCode::invalid_argument);
  EXPECT_EQ(render(ball.scene, Box3{}, small()).status().code(), StatusCode::invalid_argument);
}

TEST(Render, CamerasThatLookAlongUp) {
  const Drawn ball(test::sphere());
  Settings settings = small(Shade::normals);
  for (const Vec3& up : {Vec3{0, 0, 1}, Vec3{}, Vec3{0, 0, -7}}) {
    settings.camera = Camera{{0, 0, 5}, {}, 40, up};
    const Image image = ball.image(settings);
    EXPECT_NE(pixel(image, 30, 20).sum(), pixel(image, 0, 0).sum());
  }
}

TEST(Render, ProgressAndCancellation) {
  const Drawn ball(test::sphere());
  double last = 0;
  Execution execution;
  execution.progress = [&](double share) {
    EXPECT_GT(share, last);
    last = share;
  };
  ASSERT_TRUE(render(ball.scene, ball.set.box(), small(), execution).ok());
  EXPECT_EQ(last, 1);
  const std::atomic<bool> cancel = true;
  execution.cancel = &cancel;
  EXPECT_EQ(render(ball.scene, ball.set.box(), small(), execution).status().code(), StatusCode::cancelled);
}

}}  // namespace tessera::render
