// Ruled surfaces and Coons patches.

#include <array>
#include <functional>

#include "io/json/expression.h"
#include "io/json/json_kinds.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

std::function<double(double)> read_blend_function(const JsonValue& value) {
  static constexpr std::array<std::string_view, 1> variables{"t"};
  return [f = made(value, Expression::compile(read_text(value), variables))](double t) { return f(std::array{t}); };
}

Blend read_blend(const JsonValue& value) {
  if (!value.is(JsonKind::object)) return read_word(value, {"linear", "cubic"}) == 0 ? Blend::linear() : Blend::cubic();
  const Fields fields(value, {"coefficients", "expressions"});
  if (value.size() != 1) value.fail("expected either \"coefficients\" or \"expressions\"");
  const bool polynomial = fields.find("coefficients").has_value();
  const JsonValue pair = fields.at(polynomial ? "coefficients" : "expressions");
  auto of = array_of(pair, "2 of them, of f1 and of f2", 2).begin();
  const JsonValue first = *of;
  ++of;
  if (polynomial) return made(value, Blend::polynomial(read_numbers(first), read_numbers(*of)));
  return made(value, Blend::callable(read_blend_function(first), read_blend_function(*of)));
}

Direction read_direction(const JsonValue& value) {
  return read_word(value, {"u", "v"}) == 0 ? Direction::u : Direction::v;
}

}  // namespace

Surface read_ruled_surface(const JsonValue& value) {
  const SurfaceFields fields(value, {"first", "second", "across", "straight"});
  const BorderCurve first = read_border(fields.at("first")), second = read_border(fields.at("second"));
  return made(value, RuledSurface::make(first, second, fields.get("across", Interval{}, read_interval),
                                        fields.get("straight", Direction::v, read_direction)));
}

Surface read_coons_patch(const JsonValue& value) {
  const SurfaceFields fields(value, {"c1", "c2", "d1", "d2", "f", "g", "closing_tolerance"});
  const CoonsBorders borders{read_border(fields.at("c1")), read_border(fields.at("c2")), read_border(fields.at("d1")),
                             read_border(fields.at("d2"))};
  CoonsOptions options;
  options.f = fields.get("f", options.f, read_blend);
  options.g = fields.get("g", options.g, read_blend);
  options.closing_tolerance = fields.get("closing_tolerance", options.closing_tolerance, read_number);
  return made(value, CoonsPatch::make(borders, options));
}

}}  // namespace tessera::abi_0_1
