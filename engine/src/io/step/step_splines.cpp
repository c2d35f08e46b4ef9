#include "io/step/step_splines.h"

#include <algorithm>

#include "base/text.h"

#include "tessera/bezier_patch.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

std::string with_knots(std::string_view family) { return "B_SPLINE_" + std::string(family) + "_WITH_KNOTS"; }

/// Knots 0, 1, .., the inner ones of multiplicity `inner` and those of the ends one more than the degree.
std::vector<double> clamped_knots(int degree, std::size_t count, int inner) {
  const auto order = static_cast<std::size_t>(degree) + 1;
  std::vector<double> out(order, 0.0);
  double value = 1;
  for (std::size_t k = order; k < count; ++value)
    for (int copy = 0; copy < inner && k < count; ++copy, ++k) out.push_back(value);
  out.insert(out.end(), order, value);
  return out;
}

/// Knots that are listed with their multiplicities.
std::vector<double> listed_knots(StepEntity& entity, std::size_t multiplicities, std::size_t knots,
                                 std::size_t wanted) {
  std::vector<double> out;
  const std::vector<std::size_t> copies = entity.list(multiplicities);
  const std::vector<double> values = entity.reals(knots);
  if (!entity.status().ok()) return out;
  if (copies.size() != values.size())
    return entity.fail("has " + counted(copies.size(), "multiplicity", "multiplicities") + " for " +
                       counted(values.size(), "knot")),
           out;
  std::size_t sum = 0;
  for (std::size_t k = 0; k < copies.size() && entity.status().ok(); ++k) {
    const int copy = entity.integer(copies[k]);
    if (copy < 1) entity.fail("the multiplicity of knot " + std::to_string(k + 1) + " is below 1");
    if (k > 0 && values[k] < values[k - 1]) entity.fail("knot " + std::to_string(k + 1) + " is below the one before");
    if (!entity.status().ok()) break;
    sum += static_cast<std::size_t>(copy);
    if (sum <= wanted) out.insert(out.end(), static_cast<std::size_t>(copy), values[k]);
  }
  if (sum != wanted)
    entity.fail("the multiplicities of the knots sum up to " + std::to_string(sum) + ", expected " +
                std::to_string(wanted));
  return out;
}

}  // namespace

bool is_step_spline(const StepEntity& entity, std::string_view family) {
  const std::string name(family);
  for (const std::string& kind : {with_knots(family), "BEZIER_" + name, "QUASI_UNIFORM_" + name, "UNIFORM_" + name})
    if (entity.is(kind)) return true;
  return false;
}

SplineAttributes spline_attributes(const StepEntity& entity, std::string_view family) {
  const std::size_t before_knots = family == "CURVE" ? 5 : 7;  // degrees, points, form, flags
  if (!entity.has_parts()) return {0, 1, 0, 1 + before_knots};
  return {entity.part("B_SPLINE_" + std::string(family)), 0, entity.part(with_knots(family)), 0};
}

std::vector<double> step_knots(StepEntity& entity, std::string_view family, int degree, std::size_t count,
                               std::size_t direction) {
  const std::string name(family);
  const std::size_t wanted = count + static_cast<std::size_t>(degree) + 1;
  if (entity.is(with_knots(family))) {
    const SplineAttributes place = spline_attributes(entity, family);
    const std::size_t directions = family == "CURVE" ? 1 : 2;
    const std::size_t copies = entity.attribute(place.knots, place.knots_at + direction);
    return listed_knots(entity, copies, entity.attribute(place.knots, place.knots_at + directions + direction), wanted);
  }
  if (entity.is("UNIFORM_" + name)) {
    std::vector<double> out;
    for (std::size_t k = 0; k < wanted; ++k) out.push_back(static_cast<double>(k) - degree);
    return out;
  }
  if (entity.is("QUASI_UNIFORM_" + name)) return clamped_knots(degree, count, 1);
  if ((count - 1) % static_cast<std::size_t>(degree) != 0)
    entity.fail(counted(count, "point") + " cannot make segments of degree " + std::to_string(degree));
  return clamped_knots(degree, count, degree);
}

std::vector<double> uniform_knots(std::size_t count) { return clamped_knots(1, count, 1); }

bool check_degree(StepEntity& entity, int degree, std::size_t count) {
  if (degree < 1 || degree > max_degree)
    entity.fail("degree " + std::to_string(degree) + " is not from 1 to " + std::to_string(max_degree),
                StatusCode::unsupported_degree);
  else if (count <= static_cast<std::size_t>(degree))
    entity.fail("degree " + std::to_string(degree) + " needs more than " + counted(count, "point"));
  return entity.status().ok();
}

}}  // namespace tessera::abi_0_1
