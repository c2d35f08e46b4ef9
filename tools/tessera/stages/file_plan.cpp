#include "stages/file_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "tessera/io.h"

namespace tessera::cli {
namespace {

/// The largest |x|, |y| and |z| of points in a box, or within `distance` of it, relative to its centre.
Vec3 reach_of(const Box3& box, double distance) {
  return 0.5 * (box.upper - box.lower) + Vec3{distance, distance, distance};
}

/// Whether a model lies farther from zero than four times its size. Nearer models have no tolerance that floats
/// relative to their middle keep and floats of a file do not.
bool is_far(const Box3& box) {
  return std::max(max_abs(box.lower), max_abs(box.upper)) > 4 * max_abs(0.5 * (box.upper - box.lower));
}

bool can_hold_doubles(const std::string& path) {
  const std::string extension = lower_extension(path);
  return extension == ".obj" || extension == ".ply" || extension == ".pvtp";
}

bool has_types(const std::string& path) {
  const std::string extension = lower_extension(path);
  return extension == ".obj" || extension == ".ply";
}

/// Returns a limit without the share that rounding takes, or the whole limit if rounding takes half of it or more.
double room_beside(double limit, double rounding) { return limit > 2 * rounding ? limit - rounding : limit; }

}  // namespace

FilePlan plan_for_file(const MeshOptions& options, const Box3& box, const std::string& path, double moved) {
  FilePlan plan{.options = plan_options(options), .tolerance = std::numeric_limits<double>::infinity()};
  TessellationOptions& wanted = plan.options;
  if (wanted.rates || box.empty()) return plan;
  if (wanted.tolerance) plan.tolerance = *wanted.tolerance * (wanted.relative ? box.diagonal() : 1);
  const Vec3 reach = reach_of(box, wanted.tolerance ? plan.tolerance : 0);
  const auto rounding = [&](const std::string& file) {
    return file_rounding(file, box.centre(), reach, wanted.precision == Precision::double_precision);
  };
  // .stl holds floats always, so it tells what floats take.
  if (can_hold_doubles(path) && !options.has_precision && is_far(box) && rounding(".stl") > plan.tolerance / 16)
    wanted.precision = Precision::double_precision;
  plan.rounding = rounding(path);
  plan.has_double_sums =
      has_types(path) && plan.rounding < rounding(".stl") && wanted.precision == Precision::single_precision;
  if (wanted.pixels) {
    const double taken = pixels_of_length(options.view, box, plan.rounding);
    wanted.pixels->pixels = room_beside(wanted.pixels->pixels, taken);
  }
  if (!wanted.tolerance || !(plan.tolerance > 2 * moved)) return plan;
  wanted.relative = false;
  wanted.tolerance = room_beside(plan.tolerance - moved, plan.rounding);
  return plan;
}

void add_double_sums(Mesh& mesh) {
  if (!mesh.model_positions.empty()) return;
  const std::array<double, 3> origin{mesh.origin.x, mesh.origin.y, mesh.origin.z};
  mesh.model_positions.reserve(mesh.positions.size());
  for (std::size_t k = 0; k < mesh.positions.size(); ++k)
    mesh.model_positions.push_back(origin[k % 3] + double{mesh.positions[k]});
}

double pixels_of_length(const View& view, const Box3& box, double length_in_space) {
  const double shorter = std::min(view.width, view.height), longer = std::max(view.width, view.height);
  if (view.orthographic) return shorter / view.extent * length_in_space;
  const Vec3 sight = view.target - view.eye;
  const double distance = length(sight), slope = std::tan(view.field_of_view / 2);
  double depth = std::numeric_limits<double>::infinity();
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 point{(corner & 1 ? box.upper : box.lower).x, (corner & 2 ? box.upper : box.lower).y,
                     (corner & 4 ? box.upper : box.lower).z};
    depth = std::min(depth, dot(point - view.eye, sight) / distance);
  }
  depth = std::max(depth - length_in_space, view.near_distance > 0 ? view.near_distance : distance / 1000);
  // A point moves at most f sqrt(1 + t^2) / depth times as far in the picture, where t is the slope to a corner of it.
  return shorter / (2 * slope) * std::hypot(1, slope, slope * longer / shorter) / depth * length_in_space;
}

}  // namespace tessera::cli
