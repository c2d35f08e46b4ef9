// Curves and surfaces of three expressions.

#include <array>
#include <cmath>
#include <numbers>

#include "base/text.h"
#include "io/file/text_cursor.h"
#include "io/json/expression.h"
#include "io/json/json_kinds.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

struct Coordinate {
  JsonValue place;
  Expression expression;

  /// Fails if the expression has no value. The check is here, where the coordinate is known, rather than in the
  /// conversion.
  void probe(std::span<const std::string_view> variables, std::span<const double> values) const {
    const double value = expression(values);
    if (std::isfinite(value)) return;
    std::string at;
    for (std::size_t k = 0; k < variables.size(); ++k)
      at += (k == 0 ? " at " : ", ") + std::string(variables[k]) + " = " + text(values[k]);
    place.fail(quote(expression.text()) + " is " + (std::isnan(value) ? "NaN" : "infinite") + at,
               StatusCode::non_finite);
  }
};

/// x, y and z over the same variables.
template <std::size_t N>
struct Coordinates {
  std::array<std::string_view, N> variables;
  std::array<Coordinate, 3> xyz;

  Coordinates(const Fields& fields, std::array<std::string_view, N> names)
      : variables(names), xyz{read(fields, "x"), read(fields, "y"), read(fields, "z")} {}

  void probe(const std::array<double, N>& values) const {
    for (const Coordinate& coordinate : xyz) coordinate.probe(variables, values);
  }
  /// The function of the three, independent of the document.
  auto function() const {
    return [x = xyz[0].expression, y = xyz[1].expression, z = xyz[2].expression](auto... values) {
      const std::array<double, N> at{values...};
      return Vec3{x(at), y(at), z(at)};
    };
  }

 private:
  Coordinate read(const Fields& fields, std::string_view key) const {
    const JsonValue value = fields.at(key);
    const std::string expression = value.is(JsonKind::number) ? text(value.number()) : read_text(value);
    return {value, made(value, Expression::compile(expression, variables))};
  }
};

constexpr int probes = 8;  // intervals per direction

Disc read_disc(const JsonValue& value) {
  const Fields fields(value, {"x", "y", "radius"});
  Disc disc;
  disc.x = fields.get("x", disc.x, read_number);
  disc.y = fields.get("y", disc.y, read_number);
  disc.radius = fields.get("radius", disc.radius, read_number);
  if (!(disc.radius > 0)) value.fail("the radius is not positive");
  return disc;
}

}  // namespace

ParametricCurve read_parametric_curve(const JsonValue& value) {
  const Fields fields(value, {"kind", "x", "y", "z", "domain"});
  const Coordinates<1> coordinates(fields, {"t"});
  const Interval domain = fields.get("domain", Interval{}, read_interval);
  for (int k = 0; k <= 2 * probes; ++k) {
    const double share = k / (2.0 * probes);
    coordinates.probe({(1 - share) * domain.from + share * domain.to});
  }
  return made(value, ParametricCurve::make({.position = coordinates.function()}, domain));
}

Surface read_parametric_surface(const JsonValue& value) {
  const SurfaceFields fields(value, {"x", "y", "z", "domain", "disc"});
  const Coordinates<2> coordinates(fields, {"u", "v"});
  const std::optional<JsonValue> on_disc = fields.find("disc");
  if (on_disc && fields.find("domain")) value.fail("a surface is over a \"domain\" or over a \"disc\", not both");
  if (!on_disc) {
    const Domain domain = fields.get("domain", Domain{}, read_domain);
    for (int i = 0; i <= probes; ++i)
      for (int j = 0; j <= probes; ++j)
        coordinates.probe({domain.u_at(i / double{probes}), domain.v_at(j / double{probes})});
    return made(value, ParametricSurface::make({.position = coordinates.function()}, domain));
  }
  const Disc disc = read_disc(*on_disc);
  for (int i = 0; i <= probes; ++i)
    for (int j = 0; j < 2 * probes; ++j) {
      const double r = i / double{probes} * (1 - 0x1p-48) * disc.radius, angle = j * std::numbers::pi / probes;
      coordinates.probe({disc.x + r * std::cos(angle), disc.y + r * std::sin(angle)});
    }
  return made(value, ParametricSurface::over_disc({.position = coordinates.function()}, disc));
}

}}  // namespace tessera::abi_0_1
