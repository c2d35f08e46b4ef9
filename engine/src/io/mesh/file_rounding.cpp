#include "io/mesh/file_rounding.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "parallel/parallel_for.h"
#include "tessera/io.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The most that rounding x to float or double moves it, for |x| <= size: half a unit in the last place, or half of the
/// smallest number; and a little for rounding in this bound.
double to_float(double size) { return 0x1.00001p-24 * size + 0x1p-149; }
double to_double(double size) { return 0x1.00001p-53 * size; }

/// The length of a vector of the bounds of each axis, rounded up.
template <class Bound>
double length_of(const PositionRange& range, Bound&& bound) {
  const double x = bound(std::abs(range.origin.x), range.reach.x), y = bound(std::abs(range.origin.y), range.reach.y),
               z = bound(std::abs(range.origin.z), range.reach.z);
  return (1 + 0x1p-40) * std::sqrt(x * x + y * y + z * z);
}

/// Positions in double become floats relative to the origin.
double relative_rounding(const PositionRange& range) {
  if (!range.has_doubles) return 0;
  return length_of(range, [](double origin, double reach) { return to_float(reach) + to_double(origin + reach); });
}

/// Origin and position are added in double. Without an origin the sum is the position.
double sum_rounding(const PositionRange& range) {
  return length_of(range, [](double origin, double reach) { return origin > 0 ? to_double(origin + reach) : 0; });
}

double float_sum_rounding(const PositionRange& range) {
  return length_of(range, [](double origin, double reach) {
    return origin > 0 ? to_double(origin + reach) + to_float((1 + 0x1p-50) * (origin + reach)) : 0;
  });
}

}  // namespace

PositionRange PositionRange::of(const Mesh& mesh) {
  constexpr std::size_t piece = std::size_t{1} << 15;
  std::mutex mutex;
  Vec3 reach;
  const auto extend = [&](std::size_t begin, std::size_t end) {
    float x = 0, y = 0, z = 0;
    for (std::size_t k = 3 * begin; k < 3 * end; k += 3) {
      x = std::max(x, std::abs(mesh.positions[k]));
      y = std::max(y, std::abs(mesh.positions[k + 1]));
      z = std::max(z, std::abs(mesh.positions[k + 2]));
    }
    const std::lock_guard lock(mutex);
    reach = {std::max(reach.x, double{x}), std::max(reach.y, double{y}), std::max(reach.z, double{z})};
  };
  const std::size_t count = mesh.positions.size() / 3;
  if (!parallel_for(count, piece, {}, extend).ok()) extend(0, count);  // without memory for threads
  return {mesh.origin, reach, !mesh.model_positions.empty()};
}

bool needs_double_sums(const PositionRange& range) {
  if (range.has_doubles || range.origin == Vec3{}) return false;
  return float_sum_rounding(range) > 0x1p-16 * std::max({range.reach.x, range.reach.y, range.reach.z});
}

double file_rounding(const std::filesystem::path& path, const Vec3& origin, const Vec3& reach, bool has_doubles) {
  const PositionRange range{origin, reach, has_doubles};
  const std::string extension = lower_extension(path);
  if (extension == ".glb" || extension == ".gltf") return relative_rounding(range);
  if (extension == ".stl") return relative_rounding(range) + float_sum_rounding(range);
  if (has_doubles) return 0;
  const bool has_types = extension == ".ply" || extension == ".obj";
  return has_types && needs_double_sums(range) ? sum_rounding(range) : float_sum_rounding(range);
}

double file_rounding(const Mesh& mesh, const std::filesystem::path& path) {
  const PositionRange range = PositionRange::of(mesh);
  return file_rounding(path, range.origin, range.reach, range.has_doubles);
}

}}  // namespace tessera::abi_0_1
