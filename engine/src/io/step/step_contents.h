#pragma once
// Counts the entities in the text of a STEP file, by kind.

#include <map>
#include <string>
#include <string_view>

#include "io/step/step_index.h"

namespace tessera { inline namespace abi_0_1 {

/// The number of entities of each kind, such as "ADVANCED_FACE". An entity of several kinds counts for each; rational
/// splines, which are the most of these, are passed over. Names are those in the index's text, which must outlive them.
using StepKinds = std::map<std::string_view, std::size_t>;
StepKinds step_kinds(const StepIndex& index);

/// Shapes that neither reader takes, as "2 TESSELLATED_SOLID, 1 CSG_SOLID"; empty if there are none.
std::string unread_shapes(const StepKinds& kinds);
/// Says what a file without surfaces holds: its shapes as above, or else its most frequent kinds.
std::string contents_of(const StepKinds& kinds);

}}  // namespace tessera::abi_0_1
