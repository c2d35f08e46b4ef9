#include "stages/mesh_options.h"
#include "io/file/text_cursor.h"

#include <algorithm>

#include "console/console.h"
#include "console/memory.h"

namespace tessera::cli {
namespace {

constexpr int max_segments = 4096;
constexpr std::size_t max_triangles = std::size_t{1} << 40;

/// Adds a budget: a limit of the triangles, not a target.
void add_cap(Command& command, MeshOptions& options) {
  command
      .add_count("--max-triangles", "COUNT",
                 "Limit on triangles, not for --grid; an error says how many are needed [1073741824]", 1, max_triangles,
                 [&options](std::size_t count) { options.certified.max_triangles = count; })
      .exclude(command.option("--triangles"));
  command
      .add_flag("--fewest", "Search for a mesh with fewer triangles, not for --grid; takes 15 to 200 us per patch",
                options.certified.fewest)
      .exclude(command.option("--grid"));
}

void add_memory(Command& command, MeshOptions& options) {
  command.add("--max-memory", "SIZE", "Limit on the mesh's memory, like 800M or 12G [three quarters of what is free]",
              [&options](const std::string& text) { options.max_memory = parse_bytes("--max-memory", text); });
}

void add_weld(Command& command, MeshOptions& options) {
  const auto set_weld = [&options](const std::string& text) {
    options.certified.joining.weld = parse_numbers("--weld", text, 1, "of at least 0")[0];
    if (!(*options.certified.joining.weld >= 0))
      throw UsageError("--weld", "expected a length of at least 0, found " + quote(text));
  };
  command.add("--weld", "LENGTH",
              "Join borders within this distance of each other, not for --grid; 0: only borders with equal bits "
              "[an eighth of the tolerance]",
              set_weld);
}

/// Adds options for the normals and vertices that neighbours share.
void add_sharing(Command& command, MeshOptions& options) {
  const Option& grid = command.option("--grid");
  const auto set_crease = [&options](const std::string& text) {
    const double angle = parse_numbers("--crease", text, 1, "from 0 to 180")[0];
    if (!(angle >= 0 && angle <= 180))
      throw UsageError("--crease", "expected an angle of 0 to 180 degrees, found " + quote(text));
    options.certified.joining.crease_angle = angle * degree;
  };
  command
      .add("--crease", "DEGREES",
           "Share normals along a border where they differ by no more than this angle, and keep a crease elsewhere "
           "[each patch has its own normals]",
           set_crease)
      .exclude(grid);
  command
      .add_flag("--share-vertices",
                "Store vertices once that neighbours share: with --crease those with the same normal, otherwise all, "
                "without normals",
                options.certified.joining.share_vertices)
      .exclude(grid);
}

void add_parameters(Command& command, MeshOptions& options) {
  command.add_choice(
      "--uv", {"surface", "unit", "patch"},
      "Texture coordinates: parameters of the surface, or as shares of its domain, or of each patch, 0 to 1 "
      "[surface; with --share-vertices none: there they keep vertices apart across seams and surfaces]",
      [&options](const std::string& text) {
        options.certified.parameters = text == "patch"  ? VertexParameters::patch
                                       : text == "unit" ? VertexParameters::unit
                                                        : VertexParameters::surface;
      });
}

void add_precision(Command& command, MeshOptions& options) {
  command
      .add_choice("--precision", {"float", "double"},
                  "Precision of positions; double (.ply and .obj) keeps a small tolerance for parts far from each "
                  "other [float; .ply and .obj far from zero: double where float takes a sixteenth of the tolerance]",
                  [&options](const std::string& text) {
                    options.has_precision = true;
                    options.certified.precision =
                        text == "double" ? Precision::double_precision : Precision::single_precision;
                  })
      .exclude(command.option("--grid"));
}

}  // namespace

std::vector<const Option*> add_density(Command& command, MeshOptions& options) {
  TessellationOptions& certified = options.certified;
  command.begin_group("Density [--relative 0.001]");
  Option& grid = command.add(
      "--grid", "NxM", "Segments of every patch, along u and along v, 1 to 4096 each",
      [&options](const std::string& text) { options.grid = parse_extent("--grid", text, 1, max_segments); });
  Option& tolerance = command.add_length("--tolerance", "LENGTH",
                                         "Largest distance between mesh and surfaces, in the model's unit; proven",
                                         [&certified](double value) { certified.tolerance = value; });
  Option& relative =
      command.add_length("--relative", "SHARE", "The tolerance as a share of the model's size, the diagonal of its box",
                         [&certified](double value) {
                           certified.tolerance = value;
                           certified.relative = true;
                         });
  Option& triangles =
      command.add_count("--triangles", "COUNT", "The smallest tolerance that needs at most this many triangles", 1,
                        max_triangles, [&certified](std::size_t count) { certified.budget = count; });
  Option& angle = command.add_length(
      "--angle", "DEGREES", "Largest turn of the surfaces' normals within a triangle, up to 90; proven",
      [&certified](double value) {
        if (value > 90) throw UsageError("--angle", "expected at most 90 degrees, found " + readable(value));
        certified.angle = value * degree;
      });
  Option& pixels = command.add_length(
      "--pixels", "P", "Largest distance between mesh and surfaces in --camera's picture, in pixels; proven",
      [&options](double value) { options.pixels = value; });
  for (const Option* const other : {&tolerance, &relative, &triangles, &angle, &pixels}) grid.exclude(*other);
  tolerance.exclude(relative).exclude(triangles);
  relative.exclude(triangles);
  return {&grid, &tolerance, &relative, &triangles, &angle, &pixels};
}

void set_default(const std::vector<const Option*>& density, MeshOptions& options) {
  options.is_default = std::ranges::none_of(density, [](const Option* option) { return option->count > 0; });
  if (options.is_default) options.certified.relative = true, options.certified.tolerance = default_share;
}

void add_view(Command& command, MeshOptions& options) {
  View& view = options.view;
  const auto set_camera = [&view](const std::string& text) {
    const std::vector<double> n = parse_numbers("--camera", text, 7, "ex,ey,ez,tx,ty,tz,fovdeg");
    view.eye = {n[0], n[1], n[2]};
    view.target = {n[3], n[4], n[5]};
    view.field_of_view = n[6] * degree;
    if (view.eye == view.target) throw UsageError("--camera", "the eye and the target are the same point");
    if (!(n[6] > 0 && n[6] < 180)) throw UsageError("--camera", "the field of view must lie between 0 and 180 degrees");
  };
  const auto set_size = [&view](const std::string& text) {
    const Extent size = parse_extent("--size", text, 1, 1 << 20);
    view.width = size.first;
    view.height = size.second;
  };
  Option& pixels = command.option("--pixels");
  command.begin_group("The camera of --pixels");
  Option& camera = command.add("--camera", "EX,EY,EZ,TX,TY,TZ,FOV",
                               "Eye, target and field of view in degrees across the shorter side; z is up", set_camera);
  pixels.need(camera);
  camera.need(pixels);
  command.add("--size", "WxH", "Pixels of the camera's picture [1280x800]", set_size).need(camera);
  command
      .add_length("--near", "LENGTH", "Points nearer to the eye are not seen [a thousandth of the target's distance]",
                  [&view](double value) { view.near_distance = value; })
      .need(camera);
  command
      .add_length("--orthographic", "LENGTH",
                  "Parallel rays, and the length that the picture's shorter side shows; the field of view is not used",
                  [&view](double value) {
                    view.orthographic = true;
                    view.extent = value;
                  })
      .need(camera);
}

void add_mesh_options(Command& command, MeshOptions& options) {
  command.begin_group("The mesh");
  add_cap(command, options);
  add_memory(command, options);
  add_weld(command, options);
  add_sharing(command, options);
  add_parameters(command, options);
  command.add_flag("--quads", "Write whole cells as quads, in .obj and .ply [triangles only]", options.quads);
  add_precision(command, options);
  command
      .add_flag(
          "--strict",
          "Exit with status 1, after the mesh is written, if a part of the file is left out, a closed shape's mesh "
          "is open, or a bound is not proven; not for --grid",
          options.strict)
      .exclude(command.option("--grid"));
}

TessellationOptions plan_options(const MeshOptions& options) {
  if (options.grid)
    return {.rates = UniformRates{options.grid->first, options.grid->second},
            .parameters = options.certified.parameters,
            .quads = options.quads};
  TessellationOptions certified = options.certified;
  certified.quads = options.quads;
  if (options.pixels > 0) certified.pixels = PixelTolerance{options.pixels, options.view};
  return certified;
}

}  // namespace tessera::cli
