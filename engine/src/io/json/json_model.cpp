// .json: surfaces of every kind. tools/models/FORMAT.md describes the format.

#include <array>

#include "base/text.h"
#include "io/json/json_kinds.h"
#include "tessera/guard.h"
#include "tessera/io.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr int version = 1;

struct SurfaceReader {
  std::string_view kind;
  Surface (*read)(const JsonValue&);
};
constexpr auto readers = std::to_array<SurfaceReader>({
    {"bezier", read_bezier_patch},
    {"tensor", read_tensor_patch},
    {"b_spline", read_b_spline_surface},
    {"nurbs", read_nurbs_surface},
    {"sphere", read_sphere},
    {"torus", read_torus},
    {"cylinder", read_cylinder},
    {"cone", read_cone},
    {"revolution", read_revolution},
    {"hermite", read_hermite_patch},
    {"ferguson", read_ferguson_patch},
    {"adini", read_adini_patch},
    {"algebraic", read_algebraic_patch},
    {"through_points", read_patch_through_points},
    {"hermite_network", read_hermite_network},
    {"ruled", read_ruled_surface},
    {"coons", read_coons_patch},
    {"explicit_polynomial", read_explicit_polynomial},
    {"quadric", read_quadric},
    {"parametric", read_parametric_surface},
});

ModelSurface read_model_surface(const JsonValue& value) {
  Surface surface = read_surface(value);
  ModelSurface result{.name = {}, .surface = std::move(surface)};
  if (const auto name = value.find("name")) result.name = read_text(*name);
  if (const auto placement = value.find("placement")) result.placement = read_placement(*placement);
  if (const auto trims = value.find("trims")) result.trims = read_trims(*trims);
  return result;
}

Model read_document(const JsonValue& root) {
  const Fields fields(root, {"format", "version", "description", "surfaces"});
  const JsonValue format = fields.at("format");
  if (read_text(format) != "tessera") format.fail_expected("\"tessera\"");
  const JsonValue number = fields.at("version");
  if (read_integer(number, 1, 1 << 20) != version)
    number.fail("found version " + text(number.number()) + ", this reader knows version " + std::to_string(version),
                StatusCode::unsupported);
  if (const auto description = fields.find("description")) read_text(*description);
  Model model;
  for (const JsonValue surface : array(fields.at("surfaces"), "an array of surfaces"))
    model.surfaces.push_back(read_model_surface(surface));
  return model;
}

}  // namespace

SurfaceFields::SurfaceFields(const JsonValue& value, std::initializer_list<std::string_view> own)
    : Fields(value, {"kind", "name", "description", "placement", "trims"}, own) {
  if (const auto description = find("description")) read_text(*description);
}

Surface read_surface(const JsonValue& value) {
  if (!value.is(JsonKind::object)) value.fail_expected("a surface");
  const std::optional<JsonValue> kind = value.find("kind");
  if (!kind) value.fail("\"kind\" is missing");
  std::string known;
  for (const SurfaceReader& reader : readers) {
    if (kind->is(JsonKind::string) && kind->string() == reader.kind) return reader.read(value);
    known += (known.empty() ? "" : ", ") + std::string(reader.kind);
  }
  kind->fail_expected("one of " + known);
}

Result<Model> parse_json_model(std::string_view text, std::string_view name) {
  return guarded([&]() -> Result<Model> {
    const Result<JsonDocument> document = JsonDocument::parse(text, name);
    if (!document) return document.status();
    try {
      return read_document(document->root());
    } catch (const JsonFailure& failure) {
      return failure.status;
    }
  });
}

}}  // namespace tessera::abi_0_1
