#pragma once
// Writes text into a picture.

#include <string>
#include <vector>

#include "render/render.h"

namespace tessera::render {

/// Writes the first of `texts` that fits, or else the beginning of the last one, onto a dark strip at the picture's
/// lower border: letters (all as capitals), digits and .,:!-()/ in a font of 5 x 7 dots, scaled with the picture.
/// Pictures less than 9 pixels high are unchanged.
void add_caption(Image& image, const std::vector<std::string>& texts);

}  // namespace tessera::render
