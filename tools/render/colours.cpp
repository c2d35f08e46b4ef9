#include "render/colours.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/caption.h"

namespace tessera::render {

namespace {

constexpr Vec3 magenta{0.93, 0.20, 0.85}, violet{0.42, 0.10, 0.55};

/// The colour at a place from 0 to 1 between equally spaced stops.
Vec3 between(const std::array<Vec3, 5>& stops, double place) {
  const double at = std::max(place, 0.0) * static_cast<double>(stops.size() - 1);
  const auto before = std::min(static_cast<std::size_t>(at), stops.size() - 2);
  const double t = at - static_cast<double>(before);
  return (1 - t) * stops[before] + t * stops[before + 1];
}

}  // namespace

Vec3 error_colour(double share) {
  // Each is lighter or warmer than the one before, so that the order is visible.
  constexpr std::array<Vec3, 5> stops{
      Vec3{0.10, 0.14, 0.38}, {0.13, 0.45, 0.60}, {0.36, 0.72, 0.42}, {0.96, 0.83, 0.28}, {0.80, 0.16, 0.12}};
  return share <= 1 ? between(stops, share) : magenta;
}

Vec3 deviation_colour(double share) {
  constexpr std::array<Vec3, 5> stops{
      Vec3{0.10, 0.20, 0.62}, {0.30, 0.62, 0.85}, {0.86, 0.88, 0.84}, {0.97, 0.74, 0.30}, {0.80, 0.16, 0.12}};
  if (share < -1) return violet;
  return share <= 1 ? between(stops, 0.5 * (share + 1)) : magenta;
}

Vec3 curvature_colour(double share) {
  const Vec3 flat{0.86, 0.86, 0.84}, dome{0.78, 0.13, 0.10}, saddle{0.09, 0.25, 0.66};
  const double strength = std::min(std::abs(share), 1.0);
  return (1 - strength) * flat + strength * (share > 0 ? dome : saddle);
}

double curvature_share(double gaussian, double size) {
  const double bend = std::sqrt(std::abs(gaussian)) * size / 16;
  return std::copysign(bend / (1 + bend), gaussian);
}

double curvature_at(double share, double size) {
  const double bend = std::abs(share) / (1 - std::abs(share)) * 16 / size;
  return std::copysign(bend * bend, share);
}

Vec3 cost_colour(double steps) {
  return error_colour(std::min(1.0, std::log(std::max(steps, 1.0)) / std::log(max_steps_shown)));
}

void add_colour_bar(Image& image, const ColourBar& bar) {
  constexpr int bar_height = 6, gap = 2;  // dots of the font
  const int dot = std::max(1, image.height / 400), text_height = (text_dots_high + 2 * gap) * dot;
  const int height = (gap + bar_height) * dot + text_height, left = image.width / 5, width = image.width - 2 * left;
  int text_width = 0;
  for (const ColourBar::Mark& mark : bar.marks) text_width += text_dots_wide(mark.text + "  ") * dot;
  if (text_width > width || image.height < 4 * height) return;
  darken(image, 0, height);
  for (int x = 0; x < width; ++x) {
    const Vec3 colour = bar.colour((x + 0.5) / width);
    for (int y = gap * dot; y < (gap + bar_height) * dot; ++y) set_pixel(image, left + x, y, colour);
  }
  for (const ColourBar::Mark& mark : bar.marks) {
    const int middle = left + static_cast<int>(mark.place * width);
    add_text(image, middle - text_dots_wide(mark.text) * dot / 2, height - text_height + gap * dot, dot, mark.text);
  }
}

}  // namespace tessera::render
