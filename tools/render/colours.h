#pragma once
// Colours that stand for numbers, and the bar that explains them.

#include <functional>
#include <string>
#include <vector>

#include "render/render.h"

namespace tessera::render {

/// A share of the largest error, from 0 (deep blue) over green and yellow to 1 (red). Above 1: magenta.
Vec3 error_colour(double share);
/// A share of the largest deviation to either side: -1 (blue) over 0 (grey) to 1 (red). Beyond: violet and magenta.
Vec3 deviation_colour(double share);

/// Gaussian curvature as a share of full colour: -1 saddles (blue), 0 flat (grey), 1 domes (red).
Vec3 curvature_colour(double share);
/// The share of full colour of a Gaussian curvature (1/length^2), for a model of this size: half where the radius of
/// curvature is a sixteenth of the size.
double curvature_share(double gaussian, double size);
/// The inverse of curvature_share(), for shares between -1 and 1.
double curvature_at(double share, double size);

/// The cost of a ray, 1 to max_steps_shown, in the colours of errors; each colour stands for four times the one before.
Vec3 cost_colour(double steps);

/// Colours from left to right, and numbers at some of them.
struct ColourBar {
  struct Mark {
    double place = 0;  ///< 0 (left end) to 1 (right end)
    std::string text;
  };
  std::function<Vec3(double)> colour;  ///< at a place from 0 to 1
  std::vector<Mark> marks;
};

/// Draws the bar and its numbers onto a dark strip at the picture's upper border. Pictures that are too small for it
/// are unchanged.
void add_colour_bar(Image& image, const ColourBar& bar);

}  // namespace tessera::render
