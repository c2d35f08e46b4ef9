// Bezier patches, and tensor patches of any basis.

#include "io/json/json_kinds.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Checks that "degree", which is optional, agrees with the net.
void check_degree(const Fields& fields, int degree_u, int degree_v) {
  const std::optional<JsonValue> value = fields.find("degree");
  if (!value) return;
  auto degree = array_of(*value, "2 degrees [m, n]", 2).begin();
  for (const int wanted : {degree_u, degree_v}) {
    const int found = read_integer(*degree, 1, max_degree);
    if (found != wanted)
      (*degree).fail("the net is one of degree [" + std::to_string(degree_u) + ", " + std::to_string(degree_v) + "]");
    ++degree;
  }
}

/// Reads a basis by its name, or by the rows of its matrix. `count`: elements of the geometry in this direction.
BasisMatrix read_basis(const JsonValue& value, std::size_t count) {
  const int degree = degree_of(count);
  if (value.is(JsonKind::array)) {
    const Net<double> matrix = read_number_net(value, "entries");
    expect_shape(value, matrix, count, count, "as many as the geometry has in this direction");
    return made(value, BasisMatrix::custom(degree, matrix.elements));
  }
  const std::size_t word = read_word(value, {"bezier", "power", "uniform_b_spline", "hermite", "catmull_rom"});
  if (word >= 3 && degree != 3)
    value.fail("this basis is cubic, and the geometry has " + std::to_string(count) + " elements in this direction");
  switch (word) {
    case 0:
      return made(value, BasisMatrix::bezier(degree));
    case 1:
      return made(value, BasisMatrix::power(degree));
    case 2:
      return made(value, BasisMatrix::uniform_b_spline(degree));
    case 3:
      return made(value, BasisMatrix::hermite());
    default:
      return made(value, BasisMatrix::catmull_rom());
  }
}

}  // namespace

Surface read_bezier_patch(const JsonValue& value) {
  const SurfaceFields fields(value, {"degree", "points", "weights"});
  const Net<Vec3> net = read_vector_net(fields.at("points"));
  const int m = degree_of(net.rows), n = degree_of(net.columns);
  check_degree(fields, m, n);
  const std::optional<JsonValue> given = fields.find("weights");
  if (!given) return made(value, BezierPatch::polynomial(m, n, net.elements));
  const Net<double> weights = read_number_net(*given, "weights");
  expect_shape(*given, weights, net.rows, net.columns, "one per point");
  return made(value, BezierPatch::rational(m, n, net.elements, weights.elements));
}

Surface read_tensor_patch(const JsonValue& value) {
  const SurfaceFields fields(value, {"basis", "basis_u", "basis_v", "geometry", "domain"});
  const Net<Vec3> net = read_vector_net(fields.at("geometry"), "vectors");
  const std::optional<JsonValue> both = fields.find("basis");
  if (both && (fields.find("basis_u") || fields.find("basis_v")))
    value.fail("\"basis\" is for both directions and cannot be combined with \"basis_u\" or \"basis_v\"");
  const BasisMatrix u = read_basis(both ? *both : fields.at("basis_u"), net.rows);
  const BasisMatrix v = read_basis(both ? *both : fields.at("basis_v"), net.columns);
  return made(value, TensorPatch::make(u, v, net.elements, fields.get("domain", Domain{}, read_domain)));
}

}}  // namespace tessera::abi_0_1
