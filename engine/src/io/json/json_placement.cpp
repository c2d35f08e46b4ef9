// The placement of a surface: a list of maps, the first applied first.

#include "io/json/json_kinds.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

Vec3 read_scale(const JsonValue& value) {
  if (value.is(JsonKind::array)) return read_vector(value);
  const double factor = read_number(value);
  return {factor, factor, factor};
}

Affine read_rotation(const JsonValue& value) {
  const Fields fields(value, {"axis", "angle"});
  const Vec3 axis = read_vector(fields.at("axis"));
  if (axis == Vec3{}) fields.at("axis").fail("the axis has no direction");
  return Affine::rotated(axis, read_number(fields.at("angle")));
}

/// Reads 3 rows of 4: the linear part and, in the last column, the translation.
Affine read_matrix(const JsonValue& value) {
  const Net<double> m = read_number_net(value, "numbers");
  expect_shape(value, m, 3, 4, "the linear part and the translation");
  const auto column = [&](std::size_t j) { return Vec3{m.elements[j], m.elements[4 + j], m.elements[8 + j]}; };
  return {.columns = {column(0), column(1), column(2)}, .translation = column(3)};
}

Affine read_map(const JsonValue& value) {
  const Fields fields(value, {"translate", "scale", "rotate", "matrix"});
  if (value.size() != 1) value.fail("expected one of translate, scale, rotate, matrix");
  if (const auto by = fields.find("translate")) return Affine::translated(read_vector(*by));
  if (const auto by = fields.find("scale")) return Affine::scaled(read_scale(*by));
  if (const auto by = fields.find("rotate")) return read_rotation(*by);
  return read_matrix(fields.at("matrix"));
}

}  // namespace

Affine read_placement(const JsonValue& value) {
  Affine placement;
  for (const JsonValue map : array(value, "an array of maps", 0)) placement = read_map(map) * placement;
  if (!is_finite(placement)) value.fail("the maps together are beyond the range of double", StatusCode::non_finite);
  return placement;
}

}}  // namespace tessera::abi_0_1
