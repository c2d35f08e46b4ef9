#include "io/step/step_wholes.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <unordered_set>
#include <utility>

#include "io/step/step_transform.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Items of representations that have no shape.
constexpr std::array<std::string_view, 10> shapeless{"AXIS2_PLACEMENT_3D",
                                                     "AXIS2_PLACEMENT_2D",
                                                     "AXIS1_PLACEMENT",
                                                     "CARTESIAN_POINT",
                                                     "STYLED_ITEM",
                                                     "OVER_RIDING_STYLED_ITEM",
                                                     "MEASURE_REPRESENTATION_ITEM",
                                                     "CARTESIAN_TRANSFORMATION_OPERATOR_3D",
                                                     "VALUE_REPRESENTATION_ITEM",
                                                     "DESCRIPTIVE_REPRESENTATION_ITEM"};

/// Both rise.
bool have_common(const std::vector<std::size_t>& a, const std::vector<std::size_t>& b) {
  const bool swap = a.size() > b.size();
  const std::vector<std::size_t>&few = swap ? b : a, &many = swap ? a : b;
  return std::ranges::any_of(few, [&](std::size_t one) { return std::ranges::binary_search(many, one); });
}

/// Returns the part of a whole that has the units of another one.
StepPart& part_with(StepWhole& whole, const StepPart& like) {
  const auto found = std::ranges::find_if(whole.own, [&](const StepPart& part) {
    return part.units.length == like.units.length && part.units.angle == like.units.angle &&
           part.uncertainty == like.uncertainty;
  });
  if (found != whole.own.end()) return *found;
  StepPart& out = whole.own.emplace_back();
  out.representation = like.representation, out.units = like.units, out.uncertainty = like.uncertainty;
  return out;
}

/// Representations that are tied, and those of one product, may list the same item.
void drop_repeated_items(StepWhole& whole) {
  for (StepPart& part : whole.own) {
    std::unordered_set<std::uint64_t> seen;
    std::erase_if(part.items, [&](std::uint64_t item) { return !seen.insert(item).second; });
  }
}

/// Adds what a whole holds to another one.
void merge(const StepWhole& from, StepWhole& into) {
  into.representations.insert(into.representations.end(), from.representations.begin(), from.representations.end());
  for (const StepPart& part : from.own) {
    std::vector<std::uint64_t>& items = part_with(into, part).items;
    items.insert(items.end(), part.items.begin(), part.items.end());
  }
  std::ranges::copy_if(from.uses, std::back_inserter(into.uses),
                       [](const StepUse& use) { return use.whole != StepUse::nowhere; });
}

}  // namespace

std::size_t StepWholes::of_product(std::uint64_t definition) {
  const auto [place, is_new] = of_product_.try_emplace(definition, wholes_.size());
  if (is_new) wholes_.emplace_back().product = &structure_.products().at(definition);
  return place->second;
}

std::size_t StepWholes::of_representation(std::uint64_t number) {
  if (const auto found = of_representation_.find(number); found != of_representation_.end()) return found->second;
  const std::size_t out = wholes_.size();
  StepWhole& whole = wholes_.emplace_back();
  for (const std::uint64_t tied : structure_.tied_to(number))
    if (of_representation_.try_emplace(tied, out).second) whole.representations.push_back(tied);
  return out;
}

std::vector<std::size_t> StepWholes::product_roots() {
  std::vector<std::size_t> out;
  for (const auto& [number, product] : structure_.products()) {
    if (product.is_component) continue;
    out.push_back(of_product(number));
    read_all(out.back());
  }
  return out;
}

std::vector<std::size_t> StepWholes::representation_roots() {
  std::vector<std::size_t> all;
  for (const std::uint64_t number : structure_.shape_representations()) {
    const std::size_t whole = of_representation(number);
    if (wholes_[whole].representations.front() != number) continue;
    all.push_back(whole);
    read_all(whole);
  }
  std::vector<bool> is_held(wholes_.size(), false);
  for (const std::size_t whole : all)
    for (const StepUse& use : wholes_[whole].uses)
      if (use.whole != StepUse::nowhere) is_held[use.whole] = true;
  std::erase_if(all, [&](std::size_t whole) { return is_held[whole]; });
  if (all.size() < 2) return all;
  StepWhole& whole = wholes_.emplace_back();
  whole.is_read = true;
  for (const std::size_t root : all) merge(wholes_[root], whole);
  drop_repeated_items(whole);
  read_all(wholes_.size() - 1);
  return {wholes_.size() - 1};
}

const StepRepresentation& StepWholes::representation(std::uint64_t number) {
  const auto [place, is_new] = representations_.try_emplace(number);
  if (!is_new) return place->second;
  Result<StepRepresentation> made = step_representation(index_, number, remarks_);
  if (made)
    place->second = *std::move(made);
  else
    remarks_.add("a representation is left out: " + made.status().message());
  return place->second;
}

void StepWholes::read(std::size_t whole) {
  StepWhole& out = wholes_[whole];
  if (std::exchange(out.is_read, true)) return;
  if (out.product != nullptr)
    read_product(out, *out.product);
  else
    for (const std::uint64_t number : out.representations) read_representation(out, number);
  drop_repeated_items(out);
}

/// Returns the name of the product whose shape a whole is.
std::string StepWholes::part_name(std::size_t whole) const {
  for (const std::uint64_t number : wholes_[whole].representations)
    if (const std::uint64_t product = structure_.product_of(number); product != 0)
      return structure_.products().at(product).name;
  return {};
}

/// Returns the wholes that are the shapes of a product; they rise.
const std::vector<std::size_t>& StepWholes::shapes_of(const StepProduct& product) {
  const auto [place, is_new] = shapes_of_.try_emplace(&product);
  std::vector<std::size_t>& out = place->second;
  if (!is_new) return out;
  for (const std::uint64_t number : product.representations) out.push_back(of_representation(number));
  std::ranges::sort(out);
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

void StepWholes::read_product(StepWhole& whole, const StepProduct& product) {
  std::vector<std::size_t> mapped;
  const std::vector<std::size_t>& shapes = shapes_of(product);
  for (const std::size_t shape : shapes) {
    read(shape);
    for (const StepUse& use : wholes_[shape].uses) mapped.push_back(use.whole);
  }
  std::ranges::sort(mapped);
  mapped.erase(std::unique(mapped.begin(), mapped.end()), mapped.end());
  for (const StepOccurrence& one : product.components) {
    StepUse use{.whole = of_product(one.component), .number = one.number, .name = one.name, .contexts = one.contexts};
    const StepProduct& component = *wholes_[use.whole].product;
    // Without a place of its own, mapped items of the assembly's shape may state where it stands.
    if (!one.link && have_common(mapped, shapes_of(component))) continue;
    Result<Affine> place = one.link ? place_of(*one.link) : Affine();
    if (!place) {
      remarks_.add("a part of an assembly is left out: " + place.status().message());
      continue;
    }
    use.place = one.link && is_reversed(*one.link, product, component) ? inverse_place(*place) : *place;
    whole.uses.push_back(std::move(use));
  }
  // Several shapes are one part. Those that other products have too are not copied.
  for (const std::size_t shape : shapes) {
    const StepWhole& used = wholes_[shape];
    const std::uint64_t owner = structure_.product_of(used.representations.front());
    if (shapes.size() > 1 && owner != 0 && &structure_.products().at(owner) == &product)
      merge(used, whole);
    else
      whole.uses.push_back({.whole = shape});
  }
}

/// Tells whether a link places the assembly in its component, as some files have it.
bool StepWholes::is_reversed(const StepLink& link, const StepProduct& assembly, const StepProduct& component) {
  const auto is_of = [&](const StepProduct& product, std::uint64_t shape) {
    return std::ranges::binary_search(shapes_of(product), of_representation(shape));
  };
  return !is_of(component, link.first) && !is_of(assembly, link.second) &&
         (is_of(component, link.second) || is_of(assembly, link.first));
}

void StepWholes::read_representation(StepWhole& whole, std::uint64_t number) {
  const StepRepresentation& shape = representation(number);
  const StepPart like{number, {}, shape.units.units, shape.units.uncertainty, {}};
  StepPart* part = nullptr;
  for (const std::uint64_t item : shape.items) {
    if (is_step_kind(index_, item, "MAPPED_ITEM")) {
      add_mapped(whole, number, item);
    } else if (std::ranges::find(shapeless, index_.kind_of(item)) == shapeless.end()) {
      if (part == nullptr) part = &part_with(whole, like);
      part->items.push_back(item);
    }
  }
  for (const StepLink& link : structure_.placed_in(number)) add_placed(whole, link);
}

void StepWholes::add_mapped(StepWhole& whole, std::uint64_t number, std::uint64_t item) {
  StepEntity entity(index_, item);
  const std::size_t part = entity.part("MAPPED_ITEM"), first = entity.has_parts() ? 0 : 1;
  const std::uint64_t source = entity.reference(entity.attribute(part, first));
  const std::uint64_t target = entity.reference(entity.attribute(part, first + 1));
  Status status = entity.status();
  if (status.ok()) {
    StepEntity map(index_, source);
    const std::uint64_t origin = map.reference(map.attribute(0)), shape = map.reference(map.attribute(1));
    status = map.status();
    if (status.ok()) {
      const StepPlace from{origin, representation(shape).units.units}, to{target, representation(number).units.units};
      // An operator moves the representation as it is: the origin is that of its coordinates, as in OpenCASCADE.
      const bool is_operator = is_step_kind(index_, target, "CARTESIAN_TRANSFORMATION_OPERATOR_3D");
      const Result<Affine> place = is_operator ? step_place(index_, to) : step_move(index_, from, to);
      const std::size_t used = of_representation(shape);
      of_mapped_item_[item] = used;
      if (place)
        return whole.uses.push_back(
            {.whole = used, .place = *place, .number = item, .part_name = part_name(used), .contexts = {item}});
      status = place.status();
    }
  }
  remarks_.add("a mapped item is left out: " + status.message());
}

/// Adds a representation that a relationship places in another one, without an assembly of products.
void StepWholes::add_placed(StepWhole& whole, const StepLink& link) {
  const Result<Affine> place = place_of(link);
  if (!place) return remarks_.add("a representation is left out: " + place.status().message());
  const std::size_t used = of_representation(link.first);
  whole.uses.push_back(
      {.whole = used, .place = *place, .number = link.number, .part_name = part_name(used), .contexts = {link.number}});
}

/// Returns the map from the first representation of a link to the second.
Result<Affine> StepWholes::place_of(const StepLink& link) {
  if (link.transformation == 0) return Affine();
  const StepRepresentation &first = representation(link.first), &second = representation(link.second);
  StepEntity entity(index_, link.transformation);
  if (!entity.is("ITEM_DEFINED_TRANSFORMATION")) return step_place(index_, {link.transformation, second.units.units});
  const std::uint64_t from = entity.reference(entity.attribute(2)), to = entity.reference(entity.attribute(3));
  if (!entity.status().ok()) return entity.status();
  const auto has = [](const StepRepresentation& shape, std::uint64_t item) {
    return std::ranges::binary_search(shape.sorted_items, item);
  };
  // Some files list the placements in the other order than the representations that hold them.
  const bool is_swapped = has(second, from) && has(first, to) && !(has(first, from) && has(second, to));
  const StepPlace of_first{is_swapped ? to : from, first.units.units};
  return step_move(index_, of_first, {is_swapped ? from : to, second.units.units});
}

std::vector<std::uint64_t> StepWholes::mapped_by(std::uint64_t item) const {
  const auto found = of_mapped_item_.find(item);
  if (found == of_mapped_item_.end()) return {};
  const StepWhole& whole = wholes_[found->second];
  std::vector<std::uint64_t> out = whole.representations;
  if (whole.uses.empty() && whole.own.size() == 1 && whole.own[0].items.size() == 1)
    out.push_back(whole.own[0].items[0]);
  return out;
}

void StepWholes::read_all(std::size_t root) {
  std::vector<std::pair<std::size_t, std::size_t>> path;  // wholes and the next of their uses
  const auto enter = [&](std::size_t whole) {
    read(whole);
    wholes_[whole].state = StepWhole::open;
    wholes_[whole].places = std::min(wholes_[whole].own.size(), max_places + 1);
    path.emplace_back(whole, 0);
  };
  if (wholes_[root].state == StepWhole::unmeasured) enter(root);
  while (!path.empty()) {
    auto& [at, next] = path.back();
    StepWhole& whole = wholes_[at];
    if (next == whole.uses.size()) {
      whole.state = StepWhole::measured;
      path.pop_back();
      continue;
    }
    const StepWhole& used = wholes_[whole.uses[next].whole];
    if (used.state == StepWhole::unmeasured) {
      enter(whole.uses[next].whole);
    } else if (used.state == StepWhole::open) {
      const StepEntity entity(index_, whole.uses[next].number);
      remarks_.add(entity.error("it puts a whole into itself, and is left out").message());
      whole.uses[next++].whole = StepUse::nowhere;
    } else {
      whole.places = std::min(whole.places + used.places, max_places + 1);
      whole.depth = std::max(whole.depth, used.depth + 1);
      ++next;
    }
  }
}

}}  // namespace tessera::abi_0_1
