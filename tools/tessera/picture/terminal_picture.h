#pragma once
// Pictures as characters.

#include <string>

#include "console/terminal.h"
#include "render/render.h"

namespace tessera::cli {

/// Makes text of a picture, two rows of pixels per row of characters. With colours: upper half blocks, the upper pixel
/// in the foreground's colour, the lower one in the background's, colours reset at the end of each row. Without: a
/// character for the brightness of the two.
std::string as_characters(const render::Image& image, Colours colours);

/// The size, in pixels of half a character's height, of a picture of the usual shape that leaves two rows of the
/// terminal free.
struct PixelSize {
  int width = 0, height = 0;
};
PixelSize picture_size(const TerminalSize& terminal);

}  // namespace tessera::cli
