#include "io/step/step_styles.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "io/step/step_entity.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

struct NamedColour {
  std::string_view name;
  Colour colour;
};
constexpr std::array<NamedColour, 8> named_colours{{{"red", {1, 0, 0}},
                                                    {"green", {0, 1, 0}},
                                                    {"blue", {0, 0, 1}},
                                                    {"yellow", {1, 1, 0}},
                                                    {"magenta", {1, 0, 1}},
                                                    {"cyan", {0, 1, 1}},
                                                    {"black", {0, 0, 0}},
                                                    {"white", {1, 1, 1}}}};

/// Colours of a surface's sides, as one style or more state them.
struct SurfaceStyle {
  std::optional<Colour> fill, rendered;
  float alpha = 1;  ///< of `rendered`
};

/// Reads styles. After an error, status() is not ok, and what follows is empty.
class StyleReader {
 public:
  explicit StyleReader(const StepIndex& index)
      : style_(index), side_(index), area_(index), colour_(index), property_(index) {}

  /// Reads the styles of an item, and appends the contexts that limit them.
  std::optional<Colour> colour_of(std::span<const std::uint64_t> styles, std::vector<std::uint64_t>& contexts) {
    status_ = {};
    SurfaceStyle out;
    for (const std::uint64_t style : styles) assignment(style, out, contexts);
    if (!status_.ok()) return {};
    if (out.rendered) out.rendered->alpha = out.alpha;
    return out.rendered ? out.rendered : out.fill;
  }
  const Status& status() const { return status_; }

 private:
  /// Keeps the first error of an entity.
  bool check(const StepEntity& entity) {
    if (status_.ok()) status_ = entity.status();
    return status_.ok();
  }

  /// References of a list; typed values, such as NULL_STYLE(.NULL.), are passed over.
  static std::vector<std::uint64_t> references_in(StepEntity& entity, std::size_t at) {
    std::vector<std::uint64_t> out;
    for (const std::size_t value : entity.list(at))
      if (entity.kind_of(value) == StepKind::reference) out.push_back(entity.reference(value));
    return out;
  }

  void assignment(std::uint64_t number, SurfaceStyle& out, std::vector<std::uint64_t>& contexts) {
    StepEntity& entity = style_;
    entity.read(number);
    if (entity.is("SURFACE_STYLE_USAGE")) return usage(entity, out);
    const bool is_limited = entity.is("PRESENTATION_STYLE_BY_CONTEXT");
    if (!is_limited && !entity.is("PRESENTATION_STYLE_ASSIGNMENT")) return (void)check(entity);
    const std::vector<std::uint64_t> styles = references_in(entity, entity.attribute(0));
    if (is_limited) contexts.push_back(entity.reference(entity.attribute(1)));
    if (!check(entity)) return;
    for (const std::uint64_t style : styles) {
      entity.read(style);
      if (!check(entity)) return;
      if (entity.is("SURFACE_STYLE_USAGE")) usage(entity, out);
    }
  }

  void usage(StepEntity& entity, SurfaceStyle& out) {
    const bool is_negative = entity.enumeration(entity.attribute(0)) == "NEGATIVE";
    const std::uint64_t side = entity.reference(entity.attribute(1));
    if (!check(entity)) return;
    StepEntity& of_side = side_;
    of_side.read(side);
    const std::vector<std::uint64_t> elements =
        of_side.is("SURFACE_SIDE_STYLE") ? references_in(of_side, of_side.attribute(1)) : std::vector<std::uint64_t>();
    if (!check(of_side)) return;
    for (const std::uint64_t element : elements) {
      of_side.read(element);
      if (of_side.is("SURFACE_STYLE_FILL_AREA"))
        fill_area(of_side, is_negative, out);
      else if (of_side.is("SURFACE_STYLE_RENDERING") || of_side.is("SURFACE_STYLE_RENDERING_WITH_PROPERTIES"))
        rendering(of_side, is_negative, out);
      if (!check(of_side)) return;
    }
  }

  void fill_area(StepEntity& entity, bool is_negative, SurfaceStyle& out) {
    const std::uint64_t area = entity.reference(entity.attribute(0));
    if (!check(entity)) return;
    StepEntity& of_area = area_;
    of_area.read(area);
    const std::vector<std::uint64_t> fills =
        of_area.is("FILL_AREA_STYLE") ? references_in(of_area, of_area.attribute(1)) : std::vector<std::uint64_t>();
    if (!check(of_area)) return;
    for (const std::uint64_t fill : fills) {
      of_area.read(fill);
      if (!check(of_area)) return;
      if (!of_area.is("FILL_AREA_STYLE_COLOUR")) continue;
      const std::uint64_t colour = of_area.reference(of_area.attribute(1));
      if (!check(of_area)) return;
      if (!is_negative || !out.fill) take(colour, out.fill);
    }
  }

  void rendering(StepEntity& entity, bool is_negative, SurfaceStyle& out) {
    const std::uint64_t colour = entity.reference(entity.attribute(1));
    std::vector<std::uint64_t> properties;
    if (entity.status().ok() && entity.record().count(0) > 2) properties = references_in(entity, entity.attribute(2));
    if (!check(entity) || (is_negative && out.rendered)) return;
    take(colour, out.rendered), out.alpha = 1;
    for (const std::uint64_t property : properties) {
      StepEntity& one = property_;
      one.read(property);
      if (one.is("SURFACE_STYLE_TRANSPARENT"))
        out.alpha = static_cast<float>(std::clamp(1 - one.real(one.attribute(0)), 0.0, 1.0));
      if (!check(one)) return;
    }
  }

  /// Reads a colour; one that has no known name changes nothing.
  void take(std::uint64_t number, std::optional<Colour>& out) {
    StepEntity& entity = colour_;
    entity.read(number);
    if (entity.is("COLOUR_RGB")) {
      std::array<double, 3> parts{};
      for (std::size_t k = 0; k < 3; ++k) parts[k] = std::max(entity.real(entity.attribute(k + 1)), 0.0);
      const double scale = std::max({1.0, parts[0], parts[1], parts[2]});
      if (!check(entity)) return;
      out = Colour{static_cast<float>(parts[0] / scale), static_cast<float>(parts[1] / scale),
                   static_cast<float>(parts[2] / scale)};
    } else if (entity.is("DRAUGHTING_PRE_DEFINED_COLOUR") || entity.is("PRE_DEFINED_COLOUR")) {
      const std::string_view name = entity.string(entity.attribute(0));
      const auto found = std::ranges::find(named_colours, name, &NamedColour::name);
      if (found != named_colours.end()) out = found->colour;
    }
    (void)check(entity);
  }

  StepEntity style_, side_, area_, colour_, property_;  ///< one for each level, so that memory is reused
  Status status_;
};

constexpr std::string_view in_contexts_kind = "CONTEXT_DEPENDENT_OVER_RIDING_STYLED_ITEM";

/// Reads the styled items of one kind.
void add_styles(const StepIndex& index, std::string_view kind, StepStyles& out, StepRemarks& remarks) {
  StyleReader reader(index);
  StepEntity entity(index);
  for (const std::uint32_t place : index.of_kind(kind)) {
    entity.read(index.instances()[place].number);
    const std::vector<std::uint64_t> styles = entity.references(entity.attribute(1));
    const std::uint64_t item = entity.reference(entity.attribute(2));
    std::vector<std::uint64_t> contexts;
    if (kind == in_contexts_kind) contexts = entity.references(entity.attribute(4));
    std::optional<Colour> colour;
    if (entity.status().ok()) colour = reader.colour_of(styles, contexts);
    const Status& status = entity.status().ok() ? reader.status() : entity.status();
    if (!status.ok()) remarks.add("a colour is not read: " + status.message());
    if (!status.ok() || !colour) continue;
    if (contexts.empty() && is_step_kind(index, item, "MAPPED_ITEM")) contexts.push_back(item);
    if (contexts.empty()) {
      out.everywhere[item] = *colour;
    } else {
      for (const std::uint64_t context : contexts) out.contexts[context].push_back(out.in_contexts.size());
      out.in_contexts.push_back({std::move(contexts), item, *colour});
    }
  }
}

}  // namespace

StepStyles step_styles(const StepIndex& index, StepRemarks& remarks) {
  StepStyles out;
  for (const std::string_view kind :
       {std::string_view("STYLED_ITEM"), std::string_view("OVER_RIDING_STYLED_ITEM"), in_contexts_kind})
    add_styles(index, kind, out, remarks);
  return out;
}

}}  // namespace tessera::abi_0_1
