#include "io/step/step_tree.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "base/text.h"
#include "io/step/step_structure.h"
#include "io/step/step_wholes.h"
#include "tessera/guard.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Statements of the wholes that hold a whole, about it.
struct Above {
  Affine place;
  std::string name;       ///< of the nearest use that has one
  std::string part_name;  ///< of the nearest product that has one
  std::optional<Colour> colour;
  std::vector<std::uint64_t> contexts;  ///< in which styles are, the outermost first
};

/// Lists the places of all parts below the roots.
class StepTreeMaker {
 public:
  StepTreeMaker(const StepIndex& index, TextEncoding encoding)
      : styles_(step_styles(index, out_.remarks)),
        structure_(index, encoding, out_.remarks),
        wholes_(index, structure_, out_.remarks) {}

  Result<StepTree> make() {
    out_.colours_everywhere = std::make_shared<const StepColourMap>(std::move(styles_.everywhere));
    (void)colours_in({});
    std::vector<std::size_t> roots = wholes_.product_roots();
    if (Status status = list(roots); !status.ok()) return status;
    if (out_.places.empty()) {
      roots = wholes_.representation_roots();
      if (Status status = list(roots); !status.ok()) return status;
    }
    state_unit();
    state_unread_colours();
    return std::move(out_);
  }

 private:
  Status list(const std::vector<std::size_t>& roots) {
    std::size_t places = 0;
    for (const std::size_t root : roots) {
      places = std::min(places + wholes_[root].places, StepWholes::max_places + 1);
      if (wholes_[root].depth > StepWholes::max_depth)
        return {StatusCode::unsupported,
                "assemblies within each other more than " + std::to_string(StepWholes::max_depth) + " times"};
    }
    if (places > StepWholes::max_places)
      return {StatusCode::unsupported,
              "it places parts more than " + std::to_string(StepWholes::max_places) + " times"};
    for (const std::size_t root : roots) {
      Above above;
      if (const StepProduct* const product = wholes_[root].product) above.part_name = product->name;
      enter(root, above);
    }
    return {};
  }

  /// The depth is limited by list().
  void enter(std::size_t whole, const Above& above) {
    const StepWhole& at = wholes_[whole];
    if (at.places == 0) return;
    const std::size_t colours = colours_in(above.contexts);
    for (std::size_t k = 0; k < at.own.size(); ++k) place_part(whole, k, colours, above);
    std::optional<Colour> colour = above.colour;
    for (const std::uint64_t number : at.representations)
      if (const Colour* const own = out_.colours[colours].find(number)) colour = *own;
    for (const StepUse& use : at.uses) {
      if (use.whole == StepUse::nowhere || wholes_[use.whole].places == 0) continue;
      Above below{above.place * use.place, use.name.empty() ? above.name : use.name,
                  use.part_name.empty() ? above.part_name : use.part_name, colour, above.contexts};
      const StepProduct* const product = wholes_[use.whole].product;
      if (product != nullptr && !product->name.empty()) below.part_name = product->name;
      for (const std::uint64_t context : use.contexts)
        if (styles_.contexts.contains(context)) below.contexts.push_back(context), met_.insert(context);
      enter(use.whole, below);
    }
  }

  void place_part(std::size_t whole, std::size_t k, std::size_t colours, const Above& above) {
    if (!is_finite(above.place)) return out_.remarks.add("a part is left out: its place is beyond the range of double");
    const auto [place, is_new] = parts_.try_emplace({whole, k, above.part_name}, out_.parts.size());
    if (is_new) out_.parts.emplace_back(wholes_[whole].own[k]).name = above.part_name;
    StepPlacedPart& out = out_.places.emplace_back();
    out.part = place->second, out.colours = colours;
    out.placement = above.place, out.name = above.name.empty() ? above.part_name : above.name;
    out.colour = above.colour;
  }

  /// Returns the index of the colours in these contexts.
  std::size_t colours_in(const std::vector<std::uint64_t>& contexts) {
    const auto [place, is_new] = colours_.try_emplace(contexts, out_.colours.size());
    if (!is_new) return place->second;
    std::vector<std::pair<std::size_t, const StepContextColour*>> order;  // with the place of their deepest context
    for (const std::uint64_t context : contexts)
      for (const std::size_t k : styles_.contexts.at(context)) {
        const StepContextColour& style = styles_.in_contexts[k];
        std::size_t deepest = 0;
        for (const std::uint64_t one : style.contexts)
          deepest = std::max(deepest, static_cast<std::size_t>(std::ranges::find(contexts, one) - contexts.begin()));
        if (deepest < contexts.size()) order.emplace_back(deepest, &style);
      }
    // The outermost comes last, and so counts.
    std::ranges::stable_sort(order, std::ranges::greater(), &std::pair<std::size_t, const StepContextColour*>::first);
    StepColourMap own;
    for (const auto& [depth, style] : order) {
      own[style->item] = style->colour;
      for (const std::uint64_t shape : wholes_.mapped_by(style->item)) own[shape] = style->colour;
    }
    out_.colours.emplace_back(*out_.colours_everywhere, std::move(own));
    return place->second;
  }

  void state_unit() {
    for (const auto& [number, product] : structure_.products()) {
      if (product.is_component) continue;
      for (const std::uint64_t shape : product.representations) {
        out_.file_unit = wholes_.representation(shape).units.length;
        if (!out_.file_unit.empty()) return;
      }
    }
    if (structure_.products().empty()) return;  // as OpenCASCADE has it
    for (const std::uint64_t shape : structure_.shape_representations()) {
      out_.file_unit = wholes_.representation(shape).units.length;
      if (!out_.file_unit.empty()) return;
    }
  }

  void state_unread_colours() {
    const auto unread = std::ranges::count_if(styles_.in_contexts, [&](const StepContextColour& style) {
      return !std::ranges::all_of(style.contexts, [&](std::uint64_t context) { return met_.contains(context); });
    });
    if (unread > 0)
      out_.remarks.add(counted(static_cast<std::size_t>(unread), "colour") + " of single contexts not read");
  }

  StepTree out_;
  StepStyles styles_;
  StepStructure structure_;
  StepWholes wholes_;
  std::unordered_set<std::uint64_t> met_;  ///< contexts of uses
  std::map<std::tuple<std::size_t, std::size_t, std::string>, std::size_t> parts_;
  std::map<std::vector<std::uint64_t>, std::size_t> colours_;
};

}  // namespace

Result<StepTree> read_step_tree(const StepIndex& index, TextEncoding encoding) {
  return guarded([&]() -> Result<StepTree> { return StepTreeMaker(index, encoding).make(); });
}

}}  // namespace tessera::abi_0_1
