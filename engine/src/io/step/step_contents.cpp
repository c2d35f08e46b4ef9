#include "io/step/step_contents.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "io/step/step_index.h"
#include "io/step/step_record.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Shapes that have no surfaces of their own, or whose surfaces are not made.
constexpr std::array<std::string_view, 24> unread_kinds{"TESSELLATED_SOLID",
                                                        "TESSELLATED_SHELL",
                                                        "TRIANGULATED_FACE",
                                                        "COMPLEX_TRIANGULATED_FACE",
                                                        "CUBIC_BEZIER_TRIANGULATED_FACE",
                                                        "TRIANGULATED_SURFACE_SET",
                                                        "COMPLEX_TRIANGULATED_SURFACE_SET",
                                                        "CSG_SOLID",
                                                        "BOOLEAN_RESULT",
                                                        "BLOCK",
                                                        "RIGHT_ANGULAR_WEDGE",
                                                        "RIGHT_CIRCULAR_CYLINDER",
                                                        "RIGHT_CIRCULAR_CONE",
                                                        "SPHERE",
                                                        "TORUS",
                                                        "ELLIPSOID",
                                                        "HALF_SPACE_SOLID",
                                                        "EXTRUDED_AREA_SOLID",
                                                        "REVOLVED_AREA_SOLID",
                                                        "EXTRUDED_FACE_SOLID",
                                                        "REVOLVED_FACE_SOLID",
                                                        "SURFACE_CURVE_SWEPT_AREA_SOLID",
                                                        "SWEPT_DISK_SOLID",
                                                        "SOLID_REPLICA"};
/// Shapes that have surfaces in most files, and wires.
constexpr std::array<std::string_view, 13> others{"FACETED_BREP",
                                                  "MANIFOLD_SOLID_BREP",
                                                  "BREP_WITH_VOIDS",
                                                  "SHELL_BASED_SURFACE_MODEL",
                                                  "FACE_BASED_SURFACE_MODEL",
                                                  "ADVANCED_FACE",
                                                  "FACE_SURFACE",
                                                  "MAPPED_ITEM",
                                                  "GEOMETRIC_SET",
                                                  "GEOMETRIC_CURVE_SET",
                                                  "EDGE_BASED_WIREFRAME_MODEL",
                                                  "SHELL_BASED_WIREFRAME_MODEL",
                                                  "TESSELLATED_CURVE_SET"};

void append(std::string_view kind, std::size_t count, std::string& list) {
  list += (list.empty() ? "" : ", ") + std::to_string(count) + " " + std::string(kind);
}

std::string counts_of(const StepKinds& kinds, std::span<const std::string_view> names, std::string list = {}) {
  for (const std::string_view name : names)
    if (const auto found = kinds.find(name); found != kinds.end()) append(name, found->second, list);
  return list;
}

}  // namespace

StepKinds step_kinds(const StepIndex& index) {
  StepKinds out;
  for (std::size_t kind = 0; kind < index.kinds().size(); ++kind)
    if (const std::size_t count = index.count_of(kind); count > 0) out.emplace(index.kinds()[kind], count);
  StepRecord record;
  for (const StepInstance& one : index.instances()) {
    if (one.kind != StepIndex::several_kinds) continue;
    const bool is_spline = index.record(one).find("B_SPLINE_") != std::string_view::npos;
    if (is_spline || !record.read(index.record(one)).ok()) continue;
    for (std::size_t at = 0; at < record.size(); at = record[at].end) ++out[record[at].text];
  }
  return out;
}

std::string unread_shapes(const StepKinds& kinds) { return counts_of(kinds, unread_kinds); }

std::string contents_of(const StepKinds& kinds) {
  const std::string shapes = counts_of(kinds, others, unread_shapes(kinds));
  if (!shapes.empty() || kinds.empty()) return shapes;
  constexpr std::size_t most = 8;
  std::vector<std::pair<std::size_t, std::string_view>> order;
  for (const auto& [kind, count] : kinds) order.emplace_back(count, kind);
  std::ranges::stable_sort(order, [](const auto& a, const auto& b) { return a.first > b.first; });
  std::string list;
  for (std::size_t k = 0; k < std::min(most, order.size()); ++k) append(order[k].second, order[k].first, list);
  if (order.size() > most) list += ", and " + std::to_string(order.size() - most) + " more kinds";
  return list;
}

}}  // namespace tessera::abi_0_1
