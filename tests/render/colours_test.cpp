// Colours of numbers, and the bar that explains them.

#include "render/colours.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tessera::render { namespace {

Image blank(int width, int height) {
  return {width, height, std::vector<std::uint8_t>(3 * static_cast<std::size_t>(width * height), 255)};
}

TEST(Colours, CurvatureAndItsShareAreInverse) {
  for (const double gaussian : {-40.0, -1.0, -1e-3, 1e-3, 1.0, 40.0}) {
    const double share = curvature_share(gaussian, 3);
    EXPECT_NEAR(curvature_at(share, 3), gaussian, 1e-12 * std::abs(gaussian));
    EXPECT_LT(std::abs(share), 1);
  }
  EXPECT_EQ(curvature_share(0, 3), 0);
  EXPECT_DOUBLE_EQ(curvature_share(1 / (0.25 * 0.25), 4), 0.5);  // a radius of a sixteenth of the size
}

TEST(Colours, DeviationsAreBlueInsideAndRedOutside) {
  const Vec3 inside = deviation_colour(-1), none = deviation_colour(0), outside = deviation_colour(1);
  EXPECT_GT(inside.z, inside.x + 0.4);
  EXPECT_GT(outside.x, outside.z + 0.4);
  EXPECT_NEAR(none.x, none.z, 0.05);
  for (const double beyond : {-1.001, 1.001, -1e9, 1e9, std::nan("")})
    EXPECT_GT(deviation_colour(beyond).z, deviation_colour(beyond).y + 0.4);  // violet or magenta
  const auto blueness = [](const Vec3& colour) { return colour.z / (colour.x + colour.z); };
  for (double share = -1; share < 1; share += 0.125)  // warmer and warmer
    EXPECT_GT(blueness(deviation_colour(share)), blueness(deviation_colour(share + 0.125)));
}

TEST(Colours, TheBarShowsItsColoursAndMarks) {
  Image image = blank(400, 200);
  add_colour_bar(image, {error_colour, {{0, "0"}, {1, "0.5"}}});
  const auto pixel = [&](int x, int y) { return &image.rgb[3 * static_cast<std::size_t>(y * 400 + x)]; };
  EXPECT_GT(pixel(82, 4)[2], pixel(82, 4)[0]);    // blue at the left end
  EXPECT_GT(pixel(317, 4)[0], pixel(317, 4)[2]);  // red at the right end
  EXPECT_EQ(pixel(10, 4)[0], 63);                 // the dark strip
  EXPECT_EQ(pixel(10, 60)[0], 255);               // the picture below
  const auto is_letter = [](std::uint8_t channel) { return channel == 235; };
  EXPECT_GT(std::count_if(image.rgb.begin(), image.rgb.end(), is_letter), 3 * 30);
}

TEST(Colours, SmallPicturesHaveNoBar) {
  Image image = blank(30, 20);
  add_colour_bar(image, {error_colour, {{0, "0"}, {1, "0.5"}}});
  EXPECT_EQ(image.rgb, blank(30, 20).rgb);
}

}}  // namespace tessera::render
