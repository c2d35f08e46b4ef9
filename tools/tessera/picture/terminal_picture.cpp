#include "picture/terminal_picture.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace tessera::cli {
namespace {

using Colour = std::array<int, 3>;

Colour pixel(const render::Image& image, int x, int y) {
  const std::size_t at =
      3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x));
  return {image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]};
}

int squared_distance(const Colour& a, const Colour& b) {
  int sum = 0;
  for (std::size_t k = 0; k < 3; ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return sum;
}

/// The nearest colour of xterm's palette: 16 to 231 is a cube of the levels 0, 95, 135 ... 255; 232 to 255 are the
/// greys 8, 18 ... 238.
int palette_index(const Colour& colour) {
  constexpr std::array<int, 6> levels{0, 95, 135, 175, 215, 255};
  Colour cube{}, step{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto nearest = std::min_element(
        levels.begin(), levels.end(), [&](int a, int b) { return std::abs(a - colour[k]) < std::abs(b - colour[k]); });
    cube[k] = *nearest;
    step[k] = static_cast<int>(nearest - levels.begin());
  }
  const int grey_step = std::clamp(((colour[0] + colour[1] + colour[2]) / 3 - 3) / 10, 0, 23),
            grey = 8 + 10 * grey_step;
  if (squared_distance(colour, {grey, grey, grey}) < squared_distance(colour, cube)) return 232 + grey_step;
  return 16 + 36 * step[0] + 6 * step[1] + step[2];
}

/// "38;2;1;2;3" or "38;5;17"; `ground` is 38 for the foreground, 48 for the background (ECMA-48, ISO 8613-6).
std::string colour_code(int ground, const Colour& colour, Colours colours) {
  const std::string begin = std::to_string(ground);
  if (colours == Colours::palette_256) return begin + ";5;" + std::to_string(palette_index(colour));
  return begin + ";2;" + std::to_string(colour[0]) + ";" + std::to_string(colour[1]) + ";" + std::to_string(colour[2]);
}

void add_coloured_line(const render::Image& image, int y, Colours colours, std::string& text) {
  std::string last_upper, last_lower;
  for (int x = 0; x < image.width; ++x) {
    const std::string upper = colour_code(38, pixel(image, x, y), colours);
    const std::string lower = y + 1 < image.height ? colour_code(48, pixel(image, x, y + 1), colours) : "49";
    std::string change;
    if (upper != last_upper) change = upper;
    if (lower != last_lower) change += (change.empty() ? "" : ";") + lower;
    if (!change.empty()) text += "\x1b[" + change + "m";
    text += "\u2580";
    last_upper = upper;
    last_lower = lower;
  }
  text += "\x1b[0m\n";
}

/// Rec. 709 luma.
double brightness(const Colour& colour) { return (0.2126 * colour[0] + 0.7152 * colour[1] + 0.0722 * colour[2]) / 255; }

void add_plain_line(const render::Image& image, int y, std::string& text) {
  constexpr std::string_view ramp = " .:-=+*#%@";
  for (int x = 0; x < image.width; ++x) {
    const int below = std::min(y + 1, image.height - 1);
    const double light = (brightness(pixel(image, x, y)) + brightness(pixel(image, x, below))) / 2;
    text += ramp[std::min(static_cast<std::size_t>(light * static_cast<double>(ramp.size())), ramp.size() - 1)];
  }
  text += '\n';
}

}  // namespace

std::string as_characters(const render::Image& image, Colours colours) {
  std::string text;
  for (int y = 0; y < image.height; y += 2) {
    if (colours == Colours::none) {
      add_plain_line(image, y, text);
    } else {
      add_coloured_line(image, y, colours, text);
    }
  }
  return text;
}

PixelSize picture_size(const TerminalSize& terminal) {
  constexpr int free_lines = 2, least = 8;
  const int height = std::max(2 * (terminal.rows - free_lines), least);
  const int width = std::clamp(height * 8 / 5, least, std::max(terminal.columns, least));
  return {width, std::min(height, std::max(width * 5 / 8 & ~1, least))};
}

}  // namespace tessera::cli
