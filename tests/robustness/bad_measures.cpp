// Measures of models and solids: options out of range, solids that are open, sizes beyond the range of numbers.

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "robustness/bad_input.h"
#include "support/synthetic_sets.h"
#include "tess_trim/closed_shape.h"
#include "tessera/measures.h"
#include "tessera/topology.h"

namespace tessera::test {
namespace {

using enum StatusCode;

Model model_of_one(const Surface& surface) {
  Model model;
  model.surfaces.push_back({"", surface});
  return model;
}
BezierPatch square(double size) {
  return value_of(BezierPatch::polynomial(
      1, 1, std::array{Vec3{0, 0, 0}, Vec3{0, size, 0}, Vec3{size, 0, 0}, Vec3{size, size, 0}}));
}

void options(Table& table) {
  const Model model = model_of_one(square(1));
  table.of("measure_surfaces(model, options)");
  const auto row = [&](const std::string& input, const MeasureOptions& options) {
    table.row(input, invalid_argument, measure_surfaces(model, options));
  };
  row("accuracy 0", {.accuracy = 0});
  row("accuracy NaN", {.accuracy = std::nan("")});
  row("accuracy 1", {.accuracy = 1});
  row("max_cells 0", {.max_cells = 0});
  Model broken = model;
  broken.instances.resize(1);
  table.row("an instance of no shape", invalid_argument, measure_surfaces(broken));
  table.row("a square of side 1e200", invalid_argument, measure_surfaces(model_of_one(square(1e200))));
  table.gives("no surfaces", "no area", value_of(measure_surfaces({})).total.area.value == 0);
}

void boxes(Table& table) {
  table.of("measure_box(model)");
  table.row("a square of side 1e308", invalid_argument, measure_box(model_of_one(square(1.5e308))));
  Model cut = model_of_one(square(1));
  TrimLoop far{{space_line({5, 5, 0}, {6, 5, 0}), space_line({6, 5, 0}, {6, 6, 0}), space_line({6, 6, 0}, {5, 5, 0})}};
  cut.surfaces[0].trims = std::vector<TrimLoop>{far};
  table.row("a loop outside of the domain", invalid_argument, measure_box(cut));
  table.gives("no surfaces", "an empty box", value_of(measure_box({})).box.empty());
}

void solids(Table& table) {
  Shape cube_shape = joined(cube(), 1e-6);
  table.of("measure_solids(shape)");
  Shape open = cube_shape;
  open.shells[0].solid = 0, open.solid_count = 1;
  open.shells[0].faces.pop_back();
  table.row("a cube that lacks a face", invalid_argument, measure_solids(open));
  Shape none = cube_shape;
  none.shells = {{{}, 0}}, none.solid_count = 1;
  table.row("a solid without faces", invalid_argument, measure_solids(none));
  Shape wrong = cube_shape;
  wrong.shells[0].faces[0] = 17;
  table.row("a shell with face 17 of 6", invalid_argument, measure_solids(wrong));
  table.of("measure_enclosed(surfaces)");
  table.row("no surfaces", invalid_argument, measure_enclosed({}));
  const std::vector<ModelSurface> flat{{"", square(1)}};
  table.gives("a square", "a volume of 0, and no NaN", std::isfinite(value_of(measure_enclosed(flat)).inertia.error));
  table.of("total_of(bodies)");
  table.row("no bodies", invalid_argument, total_of({}));
}

}  // namespace

void fill_measures(Table& table) {
  options(table);
  boxes(table);
  solids(table);
}

}  // namespace tessera::test
