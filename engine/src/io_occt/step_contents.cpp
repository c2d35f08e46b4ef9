#include "io_occt/step_contents.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Shapes that have no surfaces of their own, or whose surfaces OpenCASCADE does not make.
constexpr std::array<std::string_view, 24> unread{"TESSELLATED_SOLID",
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

bool is_name(char c) { return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_'; }

/// Reads instances such as "#7=BLOCK('',#8,1.,1.,1.);" and "#9=(A(1.)B(2.));".
class KindCount {
 public:
  explicit KindCount(std::string_view text) : text_(text) {}

  StepKinds kinds() {
    while (at_ < text_.size()) step();
    return std::move(kinds_);
  }

 private:
  void step() {
    const char c = text_[at_];
    if (c == '\'' || c == '"') return skip_past(text_.substr(at_, 1));
    if (text_.substr(at_, 2) == "/*") return skip_past("*/");
    if (is_name(c)) return name();
    if (c == '=') names_at_ = 0;
    if (c == ';') names_at_ = -1, depth_ = 0;
    if (c == ')') --depth_;
    if (c == '(' && ++depth_ == 1 && names_at_ == 0) names_at_ = 1;  // no name before: one of several kinds
    ++at_;
  }

  /// Goes on behind the next `end` after the first character.
  void skip_past(std::string_view end) {
    const std::size_t found = text_.find(end, at_ + 1);
    at_ = found == std::string_view::npos ? text_.size() : found + end.size();
  }

  void name() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && is_name(text_[at_])) ++at_;
    if (depth_ != names_at_) return;
    const std::string_view word = text_.substr(begin, at_ - begin);
    const auto known = kinds_.find(word);
    if (known == kinds_.end())
      kinds_.emplace(word, 1);
    else
      ++known->second;
    if (depth_ == 0) names_at_ = -1;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  int depth_ = 0;      ///< of parentheses
  int names_at_ = -1;  ///< the depth at which names are kinds; -1: none
  StepKinds kinds_;
};

void append(std::string_view kind, std::size_t count, std::string& list) {
  list += (list.empty() ? "" : ", ") + std::to_string(count) + " " + std::string(kind);
}

std::string counts_of(const StepKinds& kinds, std::span<const std::string_view> names, std::string list = {}) {
  for (const std::string_view name : names)
    if (const auto found = kinds.find(name); found != kinds.end()) append(name, found->second, list);
  return list;
}

}  // namespace

StepKinds step_kinds(std::string_view text) {
  const std::size_t data = std::min(text.find("DATA"), text.size());
  return KindCount(text.substr(data)).kinds();
}

std::string unread_shapes(const StepKinds& kinds) { return counts_of(kinds, unread); }

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
