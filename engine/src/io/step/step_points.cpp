#include "io/step/step_points.h"

#include <array>
#include <cmath>

#include "base/text.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Axes about z, whose x is nearest to `x` (ISO 10303-42, first_proj_axis). A direction parallel to z counts as none.
Frame frame_about(const Vec3& origin, const Vec3& z, const Vec3& x) {
  constexpr double parallel = 1e-12;
  for (const Vec3& near : {x, Vec3{1, 0, 0}, Vec3{0, 1, 0}}) {
    const Vec3 across = near - dot(near, z) * z;
    if (!(length(across) > parallel)) continue;
    // The second projection removes what rounding leaves where both are nearly parallel.
    const Vec3 first = normalized(across), unit = normalized(first - dot(first, z) * z);
    return {origin, unit, cross(z, unit), z};
  }
  return {origin, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
}

/// Reads the coordinates of an entity that was read already.
Vec3 coordinates(StepEntity& entity, int dimension) {
  std::array<double, 3> c{};
  const std::size_t count = entity.reals(entity.attribute(1), c);
  if (count != static_cast<std::size_t>(dimension))
    entity.fail("expected " + counted(static_cast<std::size_t>(dimension), "coordinate") + ", found " +
                std::to_string(count));
  return entity.status().ok() ? Vec3{c[0], c[1], dimension == 3 ? c[2] : 0} : Vec3{};
}

/// Reads a place, likewise. Squares of distances must be finite.
Vec3 place_of(StepEntity& entity, const StepUnits& units) {
  constexpr double farthest = 1e150;
  const Vec3 out = units.length * coordinates(entity, units.dimension);
  if (!(max_abs(out) <= farthest)) entity.fail("its coordinates are too large", StatusCode::non_finite);
  return out;
}

/// Fails if the entity, which is read already, is of another kind.
void require(StepEntity& entity, std::string_view kind) {
  if (!entity.is(kind)) entity.fail("expected " + std::string(kind));
}

}  // namespace

Result<Vec3> StepPoints::point(std::uint64_t number) const {
  StepEntity entity(index_, number);
  require(entity, "CARTESIAN_POINT");
  const Vec3 p = place_of(entity, units_);
  if (!entity.status().ok()) return entity.status();
  return p;
}

/// Reads a list of points, with one record for all.
Result<std::vector<Vec3>> StepPoints::points(StepEntity& owner, std::size_t list) const {
  std::vector<Vec3> out;
  const std::vector<std::uint64_t> numbers = owner.references(list);
  if (!owner.status().ok()) return owner.status();
  out.reserve(numbers.size());
  StepEntity entity(index_);
  for (const std::uint64_t number : numbers) {
    entity.read(number);
    require(entity, "CARTESIAN_POINT");
    out.push_back(place_of(entity, units_));
    if (!entity.status().ok()) return entity.status();
  }
  return out;
}

Result<Vec3> StepPoints::direction(std::uint64_t number) const {
  StepEntity entity(index_, number);
  require(entity, "DIRECTION");
  const Vec3 ratios = coordinates(entity, units_.dimension);
  if (ratios == Vec3{}) entity.fail("a direction of length 0");
  if (!entity.status().ok()) return entity.status();
  return normalized(ratios);
}

Result<Vec3> StepPoints::direction_or(StepEntity& owner, std::size_t at, const Vec3& otherwise) const {
  if (owner.is_omitted(at)) return otherwise;
  const std::uint64_t number = owner.reference(at);
  if (!owner.status().ok()) return owner.status();
  return direction(number);
}

/// Reads a VECTOR, of length in the model's unit.
Result<Vec3> StepPoints::vector(std::uint64_t number) const {
  StepEntity entity(index_, number);
  require(entity, "VECTOR");
  const std::uint64_t along = entity.reference(entity.attribute(1));
  const double magnitude = entity.positive(entity.attribute(2), "magnitude") * units_.length;
  if (!std::isfinite(magnitude)) entity.fail("its magnitude is too large", StatusCode::non_finite);
  if (!entity.status().ok()) return entity.status();
  const Result<Vec3> unit = direction(along);
  if (!unit) return unit.status();
  return magnitude * *unit;
}

Result<Frame> StepPoints::placement(std::uint64_t number) const {
  StepEntity entity(index_, number);
  const bool is_flat = entity.is("AXIS2_PLACEMENT_2D"), is_axis = entity.is("AXIS1_PLACEMENT");
  if (!is_flat && !is_axis && !entity.is("AXIS2_PLACEMENT_3D")) entity.fail("expected AXIS2_PLACEMENT_3D");
  if (is_flat != (units_.dimension == 2)) entity.fail("a placement of the wrong dimension");
  const std::uint64_t at = entity.reference(entity.attribute(1));
  const std::size_t second = entity.attribute(2);
  const std::size_t third = is_flat || is_axis ? StepRecord::npos : entity.attribute(3);
  if (!entity.status().ok()) return entity.status();
  const Result<Vec3> origin = point(at);
  if (!origin) return origin.status();
  const Vec3 up{0, 0, 1}, right{1, 0, 0};
  const Result<Vec3> z = is_flat ? Result<Vec3>(up) : direction_or(entity, second, up);
  if (!z) return z.status();
  const Result<Vec3> x = is_axis ? Result<Vec3>(right) : direction_or(entity, is_flat ? second : third, right);
  if (!x) return x.status();
  return frame_about(*origin, *z, *x);
}

}}  // namespace tessera::abi_0_1
