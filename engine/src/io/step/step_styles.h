#pragma once
// Colours of a STEP file (ISO 10303-46): which items have one, wherever they stand and in single contexts.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "io/step/step_index.h"
#include "io/step/step_remarks.h"
#include "tessera/colour.h"

namespace tessera { inline namespace abi_0_1 {

using StepColourMap = std::unordered_map<std::uint64_t, Colour>;  ///< by the number of an item

/// The colours of the items of one placed part. Const calls from any number of threads.
class StepColours {
 public:
  StepColours() = default;
  /// `everywhere` must outlive the object.
  StepColours(const StepColourMap& everywhere, StepColourMap own) : everywhere_(&everywhere), own_(std::move(own)) {}

  /// Returns the colour that the file states for an item itself (a representation, solid, shell, face or mapped item),
  /// at this place or else everywhere; nullptr if there is none.
  const Colour* find(std::uint64_t item) const {
    if (const auto found = own_.find(item); found != own_.end()) return &found->second;
    if (everywhere_ == nullptr) return nullptr;
    const auto found = everywhere_->find(item);
    return found == everywhere_->end() ? nullptr : &found->second;
  }

 private:
  const StepColourMap* everywhere_ = nullptr;
  StepColourMap own_;
};

/// A colour that an item has in some contexts only.
struct StepContextColour {
  std::vector<std::uint64_t> contexts;  ///< all must hold; a mapped item is its own context
  std::uint64_t item = 0;
  Colour colour;
};

/// The colours of surfaces that a file states. Those of curves and points are left out.
///
/// - A style of an item counts after those with lower numbers, and one that overrides others after all that do not.
/// - A colour of rendering goes before one of an area's fill; transparency is that of rendering.
/// - A side that is .NEGATIVE. counts if there is no other.
/// - Values above 1 are divided by the largest.
struct StepStyles {
  StepColourMap everywhere;
  std::vector<StepContextColour> in_contexts;
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> contexts;  ///< of these, with indices into in_contexts
};

/// Reads all styles. Those that are malformed are left out, each with a remark that names the instance.
StepStyles step_styles(const StepIndex& index, StepRemarks& remarks);

}}  // namespace tessera::abi_0_1
