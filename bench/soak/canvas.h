#pragma once
// A picture to draw charts on: lines, discs, and text of 5 x 7 dots.

#include <string_view>

#include "render/render.h"

namespace tessera::bench {

struct Colour {
  std::uint8_t red = 0, green = 0, blue = 0;
};

/// Coordinates are pixels from the upper left corner. Parts outside are not drawn.
class Canvas {
 public:
  Canvas(int width, int height, Colour background);

  const render::Image& image() const { return image_; }
  void line(double x0, double y0, double x1, double y1, Colour colour, double thickness = 1);
  void disc(double x, double y, double radius, Colour colour);
  /// Draws printable ASCII, other characters as spaces; (x, y) is the upper left corner, a dot is `scale` pixels wide.
  /// Returns the width.
  int text(double x, double y, std::string_view words, Colour colour, int scale = 2);
  static int text_width(std::string_view words, int scale = 2) { return 6 * scale * static_cast<int>(words.size()); }
  static int text_height(int scale = 2) { return 7 * scale; }

 private:
  void set(int x, int y, Colour colour);
  render::Image image_;
};

}  // namespace tessera::bench
