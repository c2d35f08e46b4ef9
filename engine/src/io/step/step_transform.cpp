#include "io/step/step_transform.h"

#include <cmath>
#include <optional>

#include "io/step/step_entity.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Reads the direction of an axis, if the operator has it.
Result<std::optional<Vec3>> axis_of(const StepGeometry& geometry, StepEntity& entity, std::size_t at) {
  if (entity.is_omitted(at)) return std::optional<Vec3>();
  const std::uint64_t number = entity.reference(at);
  if (!entity.status().ok()) return entity.status();
  const Result<Vec3> direction = geometry.direction(number);
  if (!direction) return direction.status();
  return std::optional<Vec3>(*direction);
}

/// Returns the axes of an operator (ISO 10303-42, base_axis, of dimension 3). A first axis along the third one counts
/// as none.
Affine operator_axes(const std::optional<Vec3>& axis1, const std::optional<Vec3>& axis2,
                     const std::optional<Vec3>& axis3) {
  constexpr double parallel = 1e-9;
  const Vec3 z = axis3.value_or(Vec3{0, 0, 1});
  const auto across = [&](const Vec3& near) { return near - dot(near, z) * z; };
  Vec3 x = across(axis1.value_or(Vec3{1, 0, 0}));
  if (!(length(x) > parallel)) x = across({1, 0, 0});
  if (!(length(x) > parallel)) x = across({0, 0, 1});
  x = normalized(x);
  const Vec3 right_handed = cross(z, x);
  const Vec3 y = axis2 && dot(*axis2, right_handed) < 0 ? -right_handed : right_handed;
  return {.columns = {x, y, z}};
}

/// Reads CARTESIAN_TRANSFORMATION_OPERATOR_3D: its last five attributes are two axes, the origin, the scale and the
/// third axis. Before these stand the names of one or two supertypes.
Result<Affine> operator_place(const StepGeometry& geometry, StepEntity& entity) {
  const std::size_t count = entity.record().count(0), first = count < 5 ? 0 : count - 5;
  const Result<std::optional<Vec3>> axis1 = axis_of(geometry, entity, entity.attribute(first));
  if (!axis1) return axis1.status();
  const Result<std::optional<Vec3>> axis2 = axis_of(geometry, entity, entity.attribute(first + 1));
  if (!axis2) return axis2.status();
  const std::uint64_t origin = entity.reference(entity.attribute(first + 2));
  const std::size_t scale_at = entity.attribute(first + 3);
  const double scale = entity.is_omitted(scale_at) ? 1 : entity.positive(scale_at, "scale");
  const Result<std::optional<Vec3>> axis3 = axis_of(geometry, entity, entity.attribute(first + 4));
  if (!axis3) return axis3.status();
  if (!entity.status().ok()) return entity.status();
  const Result<Vec3> place = geometry.point(origin);
  if (!place) return place.status();
  Affine out = operator_axes(*axis1, *axis2, *axis3);
  for (Vec3& column : out.columns) column = scale * column;
  out.translation = *place;
  return out;
}

}  // namespace

Result<Affine> step_place(const StepIndex& index, const StepPlace& place) {
  const StepGeometry geometry(index, place.units);
  StepEntity entity(index, place.number);
  if (entity.is("CARTESIAN_TRANSFORMATION_OPERATOR_3D")) return operator_place(geometry, entity);
  const Result<Frame> frame = geometry.placement(place.number);
  if (!frame) return frame.status();
  return Affine{.columns = {frame->x, frame->y, frame->z}, .translation = frame->origin};
}

Affine inverse_place(const Affine& map) {
  // Columns are orthogonal and of equal length.
  const double square = dot(map.columns[0], map.columns[0]);
  const auto row = [&](double Vec3::*k) {
    return Vec3{map.columns[0].*k / square, map.columns[1].*k / square, map.columns[2].*k / square};
  };
  Affine out{.columns = {row(&Vec3::x), row(&Vec3::y), row(&Vec3::z)}};
  out.translation = -out.vector(map.translation);
  return out;
}

Result<Affine> step_move(const StepIndex& index, const StepPlace& from, const StepPlace& to) {
  const Result<Affine> origin = step_place(index, from);
  if (!origin) return origin.status();
  const Result<Affine> target = step_place(index, to);
  if (!target) return target.status();
  const Affine out = *target * inverse_place(*origin);
  if (!is_finite(out))
    return StepEntity(index, to.number).error("a place beyond the range of double", StatusCode::non_finite);
  return out;
}

}}  // namespace tessera::abi_0_1
