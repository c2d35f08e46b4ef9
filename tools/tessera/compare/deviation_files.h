#pragma once
// Deviations of a mesh as files: a picture in colours, or the mesh with a number at each vertex.

#include <span>
#include <string>

#include "compare/deviations.h"
#include "console/timings.h"
#include "io/file/output_file.h"
#include "render/render.h"

namespace tessera::cli {

/// How deviations are drawn.
struct DeviationPicture {
  render::Settings view;  ///< size, camera, axis that points up
  double full = 0;        ///< the deviation of the last colour, above 0
  std::string caption;    ///< at the lower border
};

/// Draws the mesh, each point in the colour of its deviation, with a bar of colours, and writes a PNG. Where surfaces
/// are closed, colours tell the sides. Errors: those of the scene, of rendering and of writing.
Status draw_deviations(const ComparedModel& model, const Mesh& mesh, const DeviationPicture& picture, OutputFile& out,
                       Timings& timings);

/// Writes the mesh as binary PLY, whose vertices have a float property `quality`, the deviation. Positions are doubles
/// if the mesh has such or an origin, floats otherwise. `deviations`: one for each vertex. Errors: those of the file.
Status write_deviation_ply(const Mesh& mesh, std::span<const float> deviations, OutputFile& out);

}  // namespace tessera::cli
