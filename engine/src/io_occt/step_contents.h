#pragma once
// Counts the entities in the text of a STEP file, by kind.

#include <map>
#include <string>
#include <string_view>

namespace tessera { inline namespace abi_0_1 {

/// The number of entities of each kind, such as "ADVANCED_FACE". An entity of several kinds counts for each.
using StepKinds = std::map<std::string, std::size_t, std::less<>>;
StepKinds step_kinds(std::string_view text);

/// Shapes that OpenCASCADE does not read, as "2 TESSELLATED_SOLID, 1 CSG_SOLID"; empty if there are none.
std::string unread_shapes(const StepKinds& kinds);
/// Says what a file without surfaces holds: its shapes as above, or else its most frequent kinds.
std::string contents_of(const StepKinds& kinds);

}}  // namespace tessera::abi_0_1
