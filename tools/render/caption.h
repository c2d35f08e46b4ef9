#pragma once
// Writes text into pictures.

#include <string>
#include <vector>

#include "render/render.h"

namespace tessera::render {

/// Writes the first of `texts` that fits, or else the beginning of the last one, onto a dark strip at the picture's
/// lower border: letters (all as capitals), digits and .,:!-+()/ in a font of 5 x 7 dots, scaled with the picture.
/// Pictures less than 9 pixels high are unchanged.
void add_caption(Image& image, const std::vector<std::string>& texts);

inline constexpr int text_dots_high = 7;  ///< the height of a letter in dots
/// The width of a text in dots.
int text_dots_wide(const std::string& text);
/// Writes a text with its upper left corner at pixel (x, y), `scale` pixels per dot; the picture cuts it off.
void add_text(Image& image, int x, int y, int scale, const std::string& text);
/// Darkens rows of pixels, as the ground of a text.
void darken(Image& image, int first_row, int rows);
/// Sets a pixel of the picture; channels from 0 to 1.
void set_pixel(Image& image, int x, int y, const Vec3& colour);

}  // namespace tessera::render
