#pragma once
// Pictures as characters.

#include <string>

#include "render/render.h"
#include "terminal.h"

namespace tessera::cli {

/// Two rows of pixels a line of characters. With colours: upper half blocks, the upper pixel in the foreground's colour, the
/// lower one in the background's, colours reset at the end of each line. Without: a character for how bright the two are.
std::string as_characters(const render::Image& image, Colours colours);

/// The size in pixels, two a character's height, of a picture of the usual shape that leaves two lines of the terminal free.
struct PixelSize {
  int width = 0, height = 0;
};
PixelSize picture_size(const TerminalSize& terminal);

}  // namespace tessera::cli
