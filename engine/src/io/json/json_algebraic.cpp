// Explicit polynomials and quadrics.

#include "io/json/json_kinds.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

QuadricCoefficients read_coefficients(const JsonValue& value) {
  const Fields fields(value, {"a", "b", "c", "d", "e", "f", "g", "h", "j", "k"});
  const auto number = [&](std::string_view key) { return fields.get(key, 0.0, read_number); };
  return {number("a"), number("b"), number("c"), number("d"), number("e"),
          number("f"), number("g"), number("h"), number("j"), number("k")};
}

}  // namespace

Surface read_explicit_polynomial(const JsonValue& value) {
  const SurfaceFields fields(value, {"coefficients", "domain"});
  const Net<double> net = read_number_net(fields.at("coefficients"), "coefficients");
  return made(value, ExplicitPolynomial::make(degree_of(net.rows), degree_of(net.columns), net.elements,
                                              fields.get("domain", Domain{}, read_domain)));
}

Surface read_quadric(const JsonValue& value) {
  const SurfaceFields fields(value, {"coefficients", "range", "sheet", "tolerance", "length"});
  QuadricOptions options;
  options.tolerance = fields.get("tolerance", options.tolerance, read_number);
  options.length = fields.get("length", options.length, read_number);
  const JsonValue coefficients = fields.at("coefficients");
  const Quadric quadric = made(coefficients, Quadric::make(read_coefficients(coefficients), options));
  const int sheet = fields.get("sheet", 0, [](const JsonValue& v) { return read_integer(v, 0, 1); });
  return made(value, QuadricPiece::make(quadric, read_domain(fields.at("range")), sheet));
}

}}  // namespace tessera::abi_0_1
