#include "io/step/step_structure.h"

#include <algorithm>
#include <array>
#include <utility>

#include "base/text.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

bool is_blank_text(std::string_view text) { return text.find_first_not_of(' ') == std::string_view::npos; }

}  // namespace

StepStructure::StepStructure(const StepIndex& index, TextEncoding encoding, StepRemarks& remarks)
    : index_(index), encoding_(encoding), remarks_(remarks) {
  read_products();
  read_occurrences();
  read_places();
  read_shapes();
  read_relationships();
  occurrences_.clear();
}

std::string StepStructure::text(std::string_view raw) const {
  return encoding_ == TextEncoding::utf8 ? step_text(raw) : step_text(to_utf8(std::string(raw), encoding_));
}

/// Returns the instances that are of a kind alone, and those of several kinds that have a part, by their numbers.
std::vector<std::uint64_t> StepStructure::numbers_of(std::string_view kind, std::string_view part) const {
  std::vector<std::uint64_t> out;
  for (const std::uint32_t place : index_.of_kind(kind)) out.push_back(index_.instances()[place].number);
  if (!part.empty())
    for (const std::uint32_t place : index_.with_part(part)) out.push_back(index_.instances()[place].number);
  std::ranges::sort(out);
  return out;
}

void StepStructure::read_products() {
  for (const char* const kind : {"PRODUCT_DEFINITION", "PRODUCT_DEFINITION_WITH_ASSOCIATED_DOCUMENTS"})
    for (const std::uint64_t number : numbers_of(kind, {})) products_[number].name = product_name(number);
}

/// Returns the name of the product, or else its id; empty if it has neither, or if the file has no product here.
std::string StepStructure::product_name(std::uint64_t definition) const {
  StepEntity entity(index_, definition);
  for (int k = 0; k < 2; ++k)  // the third attribute of the definition is its formation, which has the product there
    if (const std::uint64_t next = entity.reference(entity.attribute(2)); next != 0) entity.read(next);
  const std::string_view id = entity.string(entity.attribute(0)), name = entity.string(entity.attribute(1));
  if (!entity.status().ok()) return {};
  return text(name.empty() ? id : name);
}

void StepStructure::read_occurrences() {
  StepEntity entity(index_);
  constexpr std::string_view kind = "NEXT_ASSEMBLY_USAGE_OCCURRENCE";
  for (const std::uint64_t number : numbers_of(kind, kind)) {
    entity.read(number);
    const std::size_t part = entity.has_parts() ? entity.part("PRODUCT_DEFINITION_RELATIONSHIP") : 0;
    const std::string_view id = entity.string(entity.attribute(part, 0)),
                           name = entity.string(entity.attribute(part, 1));
    const std::uint64_t assembly = entity.reference(entity.attribute(part, 3));
    const std::uint64_t component = entity.reference(entity.attribute(part, 4));
    if (entity.status().ok() && (!products_.contains(assembly) || !products_.contains(component)))
      entity.fail("it does not tie two instances of PRODUCT_DEFINITION");
    if (!entity.status().ok()) {
      remarks_.add("a part of an assembly is left out: " + entity.status().message());
      continue;
    }
    products_[component].is_component |= assembly != component;
    StepOccurrence out;
    out.number = number, out.component = component, out.contexts = {number};
    out.name = text(is_blank_text(name) ? id : name);
    if (is_blank_text(out.name)) out.name.clear();
    products_[assembly].components.push_back(std::move(out));
  }
  for (auto& [number, product] : products_)
    for (StepOccurrence& occurrence : product.components) occurrences_[occurrence.number] = &occurrence;
}

std::uint64_t StepStructure::owner_of_shape(StepEntity& entity, std::size_t k) const {
  const std::uint64_t shape = entity.reference(entity.attribute(k));
  if (!entity.status().ok()) return 0;
  StepEntity property(index_, shape);
  const std::uint64_t owner = property.reference(property.attribute(2));
  if (!property.status().ok()) entity.fail(property.status().message());
  return owner;
}

/// Reads what representations are the shapes of: products, or single uses of these.
void StepStructure::read_shapes() {
  StepEntity entity(index_);
  for (const std::uint64_t number : numbers_of("SHAPE_DEFINITION_REPRESENTATION", {})) {
    entity.read(number);
    const std::uint64_t owner = owner_of_shape(entity, 0), shape = entity.reference(entity.attribute(1));
    if (!entity.status().ok()) {
      remarks_.add("a shape is left out: " + entity.status().message());
    } else if (const auto product = products_.find(owner); product != products_.end()) {
      product->second.representations.push_back(shape);
      product_of_.try_emplace(shape, owner);
    } else if (const auto use = occurrences_.find(owner); use != occurrences_.end()) {
      use->second->contexts.push_back(shape);
    }
  }
}

/// Reads where components stand in their assemblies.
void StepStructure::read_places() {
  StepEntity entity(index_);
  for (const std::uint64_t number : numbers_of("CONTEXT_DEPENDENT_SHAPE_REPRESENTATION", {})) {
    entity.read(number);
    const std::uint64_t relationship = entity.reference(entity.attribute(0)), owner = owner_of_shape(entity, 1);
    const auto use = occurrences_.find(owner);
    if (entity.status().ok() && use != occurrences_.end()) {
      of_occurrences_.insert(relationship);
      StepEntity tie(index_, relationship);
      const StepLink link = link_of(tie);
      if (!tie.status().ok()) entity.fail(tie.status().message());
      if (entity.status().ok() && !use->second->link) use->second->link = link;
      use->second->contexts.insert(use->second->contexts.end(), {number, relationship});
    }
    if (!entity.status().ok()) remarks_.add("a place in an assembly is not read: " + entity.status().message());
  }
}

StepLink StepStructure::link_of(StepEntity& entity) const {
  const std::size_t part = entity.has_parts() ? entity.part("REPRESENTATION_RELATIONSHIP") : 0;
  StepLink out;
  out.first = entity.reference(entity.attribute(part, 2)), out.second = entity.reference(entity.attribute(part, 3));
  if (const std::size_t with = entity.part("REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION"); with != StepRecord::npos)
    out.transformation = entity.reference(entity.attribute(with, entity.has_parts() ? 0 : 4));
  return out;
}

/// Reads the relationships that are of no use of a component.
void StepStructure::read_relationships() {
  constexpr std::array<std::string_view, 2> kinds{"SHAPE_REPRESENTATION_RELATIONSHIP",
                                                  "REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION"};
  std::vector<std::uint64_t> numbers;
  for (const std::string_view kind : kinds) {
    const std::vector<std::uint64_t> more = numbers_of(kind, kind);
    numbers.insert(numbers.end(), more.begin(), more.end());
  }
  std::ranges::sort(numbers);
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  StepEntity entity(index_);
  for (const std::uint64_t number : numbers) {
    if (of_occurrences_.contains(number)) continue;
    entity.read(number);
    StepLink link = link_of(entity);
    link.number = number;
    if (!entity.status().ok()) {
      remarks_.add("two representations are not tied: " + entity.status().message());
    } else if (link.transformation != 0) {
      placed_in_[link.second].push_back(link);
    } else {
      ties_[link.first].push_back(link.second);
      ties_[link.second].push_back(link.first);
    }
  }
}

bool StepStructure::is_shape_representation(std::uint64_t number) const {
  constexpr std::string_view word = "SHAPE_REPRESENTATION";
  const std::string_view kind = index_.kind_of(number);
  if (kind.empty()) return StepEntity(index_, number).is(word);
  return kind.ends_with(word) || kind == "SHAPE_REPRESENTATION_WITH_PARAMETERS";
}

std::vector<std::uint64_t> StepStructure::shape_representations() const {
  std::vector<std::uint64_t> out;
  for (const std::string_view kind : index_.kinds())
    for (const std::uint32_t place : index_.of_kind(kind)) {
      const std::uint64_t number = index_.instances()[place].number;
      if (kind == "CONTEXT_DEPENDENT_SHAPE_REPRESENTATION" || !is_shape_representation(number)) break;
      out.push_back(number);
    }
  for (const std::uint32_t place : index_.with_part("SHAPE_REPRESENTATION"))
    out.push_back(index_.instances()[place].number);
  std::ranges::sort(out);
  return out;
}

std::uint64_t StepStructure::product_of(std::uint64_t representation) const {
  const auto found = product_of_.find(representation);
  return found == product_of_.end() ? 0 : found->second;
}

std::vector<std::uint64_t> StepStructure::tied_to(std::uint64_t representation) const {
  std::vector<std::uint64_t> out{representation};
  std::unordered_set<std::uint64_t> seen{representation};
  std::uint64_t product = product_of(representation);
  for (std::size_t k = 0; k < out.size(); ++k) {
    const auto ties = ties_.find(out[k]);
    if (ties == ties_.end()) continue;
    for (const std::uint64_t other : ties->second) {
      const std::uint64_t owner = product_of(other);
      if (owner != 0 && product != 0 && owner != product) continue;
      if (!is_shape_representation(other) || !seen.insert(other).second) continue;
      if (owner != 0) product = owner;
      out.push_back(other);
    }
  }
  return out;
}

const std::vector<StepLink>& StepStructure::placed_in(std::uint64_t representation) const {
  static const std::vector<StepLink> none;
  const auto found = placed_in_.find(representation);
  return found == placed_in_.end() ? none : found->second;
}

Result<StepRepresentation> step_representation(const StepIndex& index, std::uint64_t number, StepRemarks& remarks) {
  StepEntity entity(index, number);
  const std::size_t part = entity.has_parts() ? entity.part("REPRESENTATION") : 0;
  const std::size_t context = entity.attribute(part, 2);
  StepRepresentation out;
  std::size_t missing = 0;
  for (const std::size_t at : entity.list(entity.attribute(part, 1))) {
    const StepValue& value = entity.record()[at];
    if (value.kind == StepKind::reference && index.find(value.reference) != nullptr)
      out.items.push_back(value.reference);
    else
      ++missing;
  }
  if (!entity.status().ok()) return entity.status();
  if (missing > 0) remarks.add(entity.error(counted(missing, "item") + " left out: no instance of the file").message());
  out.sorted_items = out.items;
  std::ranges::sort(out.sorted_items);
  if (entity.is_omitted(context)) return out;
  const std::uint64_t units_at = entity.reference(context);
  if (!entity.status().ok()) return entity.status();
  Result<StepContextUnits> units = step_units(index, units_at);
  if (!units) return units.status();
  out.units = *std::move(units);
  return out;
}

}}  // namespace tessera::abi_0_1
