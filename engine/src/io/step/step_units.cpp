#include "io/step/step_units.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "io/step/step_entity.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr int max_unit_depth = 8;  ///< of units that are multiples of others

struct SiPrefix {
  std::string_view name;
  double factor;
};
constexpr std::array<SiPrefix, 16> si_prefixes{{{"EXA", 1e18},
                                                {"PETA", 1e15},
                                                {"TERA", 1e12},
                                                {"GIGA", 1e9},
                                                {"MEGA", 1e6},
                                                {"KILO", 1e3},
                                                {"HECTO", 1e2},
                                                {"DECA", 1e1},
                                                {"DECI", 1e-1},
                                                {"CENTI", 1e-2},
                                                {"MILLI", 1e-3},
                                                {"MICRO", 1e-6},
                                                {"NANO", 1e-9},
                                                {"PICO", 1e-12},
                                                {"FEMTO", 1e-15},
                                                {"ATTO", 1e-18}}};

enum class UnitKind { other, length, angle };

struct Unit {
  UnitKind kind = UnitKind::other;
  double factor = 1;  ///< millimetres or radians in one
  std::string name;
};

std::string lower_case(std::string_view word) {
  std::string out(word);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

/// The quantity that the entity measures, by a part such as LENGTH_UNIT.
UnitKind stated_kind(const StepEntity& entity) {
  return entity.is("LENGTH_UNIT")        ? UnitKind::length
         : entity.is("PLANE_ANGLE_UNIT") ? UnitKind::angle
                                         : UnitKind::other;
}

/// Reads SI_UNIT(.MILLI.,.METRE.), which has the dimensions before these if it stands alone. Some files leave out the
/// prefix without a $.
Unit si_unit(StepEntity& entity) {
  const std::size_t part = entity.part("SI_UNIT"), first = entity.has_parts() ? 0 : 1;
  const bool has_prefix = !entity.has_parts() || entity.record().count(part) != 1;
  const std::size_t prefix = has_prefix ? entity.attribute(part, first) : StepRecord::npos;
  const std::string_view name = entity.enumeration(entity.attribute(part, first + has_prefix));
  Unit out;
  if (name == "METRE") out.kind = UnitKind::length, out.factor = 1000;
  if (name == "RADIAN") out.kind = UnitKind::angle;
  if (out.kind == UnitKind::other) {
    if (stated_kind(entity) != UnitKind::other) entity.fail("expected .METRE. or .RADIAN.");
    return out;
  }
  if (has_prefix && !entity.is_omitted(prefix)) {
    const std::string_view word = entity.enumeration(prefix);
    const auto found = std::ranges::find(si_prefixes, word, &SiPrefix::name);
    if (found == si_prefixes.end()) return entity.fail("." + std::string(word) + ". is no prefix of a unit"), out;
    out.factor *= found->factor, out.name = lower_case(word);
  }
  out.name += lower_case(name);
  return out;
}

Result<Unit> unit_of(const StepIndex& index, std::uint64_t number, int depth);

/// Reads a value with its unit, such as LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#5), as one unit.
Result<Unit> measure_of(const StepIndex& index, StepEntity& entity, int depth) {
  const std::size_t part = entity.has_parts() ? entity.part("MEASURE_WITH_UNIT") : 0;
  const double value = entity.positive(entity.attribute(part, 0), "value");
  const std::uint64_t basis = entity.reference(entity.attribute(part, 1));
  if (!entity.status().ok()) return entity.status();
  Result<Unit> out = unit_of(index, basis, depth + 1);
  if (!out) return out;
  out->factor *= value;
  if (!(out->factor > 0) || !std::isfinite(out->factor))
    return entity.error("a unit beyond the range of double", StatusCode::non_finite);
  return out;
}

/// Reads CONVERSION_BASED_UNIT('INCH',#4).
Result<Unit> conversion_based_unit(const StepIndex& index, StepEntity& entity, int depth) {
  const std::size_t part = entity.part("CONVERSION_BASED_UNIT"), first = entity.has_parts() ? 0 : 1;
  const std::string name = step_text(entity.string(entity.attribute(part, first)));
  const std::uint64_t factor = entity.reference(entity.attribute(part, first + 1));
  if (!entity.status().ok()) return entity.status();
  StepEntity measure(index, factor);
  Result<Unit> out = measure_of(index, measure, depth);
  if (!out) return out;
  const UnitKind stated = stated_kind(entity);
  if (stated != UnitKind::other && out->kind != stated) return entity.error("it is a multiple of another kind of unit");
  out->name = name;
  return out;
}

/// Reads a unit of any kind; what is neither of lengths nor of angles is not looked at.
Result<Unit> unit_of(const StepIndex& index, std::uint64_t number, int depth) {
  StepEntity entity(index, number);
  if (!entity.status().ok()) return entity.status();
  if (depth > max_unit_depth) return entity.error("units that are multiples of others more than 8 times, or a cycle");
  if (entity.has_parts() && stated_kind(entity) == UnitKind::other) return Unit();
  if (entity.is("CONVERSION_BASED_UNIT")) return conversion_based_unit(index, entity, depth);
  if (!entity.is("SI_UNIT")) {
    if (stated_kind(entity) != UnitKind::other) return entity.error("a unit without a size");
    return Unit();
  }
  Unit out = si_unit(entity);
  if (!entity.status().ok()) return entity.status();
  return out;
}

/// Reads an uncertainty of lengths; none if it is of something else, or cannot be read.
std::optional<double> uncertainty_of(const StepIndex& index, std::uint64_t number) {
  StepEntity entity(index, number);
  if (!entity.is("UNCERTAINTY_MEASURE_WITH_UNIT")) return {};
  const Result<Unit> measure = measure_of(index, entity, 0);
  if (!measure || measure->kind != UnitKind::length) return {};
  return measure->factor;
}

}  // namespace

Result<StepContextUnits> step_units(const StepIndex& index, std::uint64_t context) {
  StepEntity entity(index, context);
  StepContextUnits out;
  bool has_length = false, has_angle = false;
  if (const std::size_t part = entity.part("GLOBAL_UNIT_ASSIGNED_CONTEXT"); part != StepRecord::npos)
    for (const std::uint64_t number : entity.references(entity.attribute(part, entity.has_parts() ? 0 : 2))) {
      if (!entity.status().ok()) break;
      Result<Unit> unit = unit_of(index, number, 0);
      if (!unit) return unit.status();
      if (unit->kind == UnitKind::length && !std::exchange(has_length, true))
        out.units.length = unit->factor, out.length = std::move(unit->name);
      if (unit->kind == UnitKind::angle && !std::exchange(has_angle, true)) out.units.angle = unit->factor;
    }
  if (!entity.status().ok()) return entity.status();
  if (const std::size_t part = entity.part("GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT"); part != StepRecord::npos)
    for (const std::uint64_t number : entity.references(entity.attribute(part, entity.has_parts() ? 0 : 2)))
      if (const std::optional<double> size = uncertainty_of(index, number); size && out.uncertainty == 0)
        out.uncertainty = *size;
  return out;
}

}}  // namespace tessera::abi_0_1
