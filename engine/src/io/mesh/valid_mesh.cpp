#include "io/mesh/valid_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>

#include "io/mesh/mesh_formats.h"
#include "parallel/least_index.h"
#include "tess/mesh/mesh_parts.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

Status invalid(std::string message, std::size_t index) {
  return {StatusCode::invalid_argument, std::move(message), static_cast<std::ptrdiff_t>(index)};
}

/// The first of [begin, end) for which `bad` holds, or `end`. Searches only if there is one: the test whether there is
/// any takes no branches.
template <class Bad>
std::size_t first_bad(std::size_t begin, std::size_t end, const Bad& bad) {
  unsigned any = 0;
  for (std::size_t k = begin; k < end; ++k) any |= bad(k) ? 1u : 0u;
  if (any == 0) return end;
  while (!bad(begin)) ++begin;
  return begin;
}

/// The first value that is not finite, or whose magnitude is above `bound`.
Result<std::size_t> first_beyond(std::span<const float> values, float bound) {
  return find_first(values.size(), [&](std::size_t begin, std::size_t end) {
    return first_bad(begin, end, [&](std::size_t k) { return !(std::abs(values[k]) <= bound); });
  });
}
Result<std::size_t> first_not_finite(std::span<const float> values) {
  return first_beyond(values, std::numeric_limits<float>::max());
}

/// The first vertex whose coordinates in the model's space exceed the range of float.
Result<std::size_t> first_misplaced(const Mesh& mesh) {
  const std::array<double, 3> origin{mesh.origin.x, mesh.origin.y, mesh.origin.z};
  constexpr float ample = 1e38f;  // the sum of two such numbers fits float
  const auto is_small = [](double x) { return std::abs(x) <= double{ample}; };
  Result<std::size_t> large = first_beyond(mesh.positions, ample);
  if (!large) return large;
  const bool all_small = std::all_of(origin.begin(), origin.end(), is_small);
  if (all_small && *large == mesh.positions.size()) return mesh.vertex_count();
  for (std::size_t k = 0; k < mesh.positions.size(); ++k)
    if (!std::isfinite(file_coordinate(origin[k % 3], mesh.positions[k]))) return k / 3;
  return mesh.vertex_count();
}

Status check_lengths(const Mesh& mesh) {
  const std::size_t vertices = mesh.vertex_count(), triangles = mesh.triangle_count();
  const bool lengths_fit = mesh.positions.size() == 3 * vertices && mesh.indices.size() == 3 * triangles &&
                           (mesh.model_positions.empty() || mesh.model_positions.size() == 3 * vertices) &&
                           (mesh.normals.empty() || mesh.normals.size() == 3 * vertices) &&
                           (mesh.parameters.empty() || mesh.parameters.size() == 2 * vertices) &&
                           (mesh.patches.empty() || mesh.patches.size() == triangles) &&
                           mesh.quads.size() == 4 * mesh.quad_count() &&
                           (mesh.quad_patches.empty() || mesh.quad_patches.size() == mesh.quad_count());
  if (!lengths_fit) return {StatusCode::count_mismatch, "the mesh's arrays have lengths that do not fit each other"};
  if (vertices == 0) return {StatusCode::invalid_argument, "the mesh has no vertices"};
  if (vertices > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    return {StatusCode::invalid_argument, "the mesh has more vertices than files can index (2147483647)"};
  return {};
}

Status check_indices(const Mesh& mesh) {
  const auto vertices = static_cast<std::uint32_t>(mesh.vertex_count());
  for (const std::span<const std::uint32_t> indices : {std::span(mesh.indices), std::span(mesh.quads)}) {
    const Result<std::size_t> bad = find_first(indices.size(), [&](std::size_t begin, std::size_t end) {
      return first_bad(begin, end, [&](std::size_t k) { return indices[k] >= vertices; });
    });
    if (!bad) return bad.status();
    if (*bad != indices.size()) return invalid("an index of the mesh is beyond its vertices", *bad);
  }
  return {};
}

Status check_numbers(const Mesh& mesh) {
  const Result<std::size_t> vertex = first_misplaced(mesh), normal = first_not_finite(mesh.normals),
                            parameter = first_not_finite(mesh.parameters);
  for (const Result<std::size_t>* found : {&vertex, &normal, &parameter})
    if (!*found) return found->status();
  const auto not_finite = std::find_if_not(mesh.model_positions.begin(), mesh.model_positions.end(),
                                           [](double x) { return std::isfinite(x); });
  if (not_finite != mesh.model_positions.end())
    return {StatusCode::non_finite, "a position in double of the mesh is not finite",
            (not_finite - mesh.model_positions.begin()) / 3};
  const std::size_t bad = std::min(*vertex, mesh.normals.empty() ? *vertex : *normal / 3);
  if (bad < mesh.vertex_count())
    return {StatusCode::non_finite, "a vertex of the mesh is not finite in float", static_cast<std::ptrdiff_t>(bad)};
  if (*parameter < mesh.parameters.size())
    return {StatusCode::non_finite, "a parameter of the mesh is not finite",
            static_cast<std::ptrdiff_t>(*parameter / 2)};
  return {};
}

bool is_valid(const std::optional<Colour>& colour) {
  const auto is_share = [](float x) { return x >= 0 && x <= 1; };
  return !colour ||
         (is_share(colour->red) && is_share(colour->green) && is_share(colour->blue) && is_share(colour->alpha));
}

Status check_colours(const Mesh& mesh) {
  const auto bad = std::ranges::find_if_not(mesh.parts, [](const MeshPart& part) { return is_valid(part.colour); });
  if (bad == mesh.parts.end()) return {};
  return invalid("the colour of a part of the mesh is not within 0 to 1",
                 static_cast<std::size_t>(bad - mesh.parts.begin()));
}

bool is_in_float(const Affine& placement) {
  constexpr double largest = std::numeric_limits<float>::max();
  const auto is_small = [](const Vec3& v) { return max_abs(v) <= largest; };
  return std::ranges::all_of(placement.columns, is_small) && is_small(placement.translation);
}

Status check_instance(const MeshInstance& instance, std::size_t shapes) {
  if (instance.shape >= shapes)
    return {StatusCode::invalid_argument,
            "it is of shape " + std::to_string(instance.shape) + ", there are " + std::to_string(shapes)};
  if (!is_finite(instance.placement)) return {StatusCode::non_finite, "its placement is not finite"};
  if (!is_in_float(instance.placement)) return {StatusCode::non_finite, "its placement is beyond the range of float"};
  if (!is_valid(instance.colour)) return {StatusCode::invalid_argument, "its colour is not within 0 to 1"};
  return {};
}

/// "instance 3 (bolt): ...".
Status in_item(const char* kind, std::size_t k, const std::string& name, const Status& status) {
  return {
      status.code(),
      std::string(kind) + " " + std::to_string(k) + (name.empty() ? "" : " (" + name + ")") + ": " + status.message(),
      static_cast<std::ptrdiff_t>(k)};
}

}  // namespace

Status validate(const Mesh& mesh) {
  for (Status (*const check)(const Mesh&) : {check_lengths, check_indices, check_numbers, check_parts, check_colours})
    if (Status status = check(mesh); !status.ok()) return status;
  return {};
}

Status validate_piece(const Mesh& piece, const MeshTotals& totals) {
  const MeshTotals own = MeshTotals::of(piece);
  const bool has_faces = own.triangles + own.quads > 0;
  if (own.vertices == 0 && !has_faces) return {};
  if (Status status = validate(piece); !status.ok()) return status;
  if (own.normals != totals.normals || own.parameters != totals.parameters ||
      (has_faces && own.patches != totals.patches) || own.double_positions != totals.double_positions)
    return {StatusCode::count_mismatch, "a piece of the mesh has other attributes than the whole"};
  return {};
}

Status check_patches(const Mesh& mesh, std::uint64_t first_patch) {
  if (first_patch == 0 || !mesh.has_patches()) return {};
  std::uint64_t most = 0;
  for (const auto* const patches : {&mesh.patches, &mesh.quad_patches})
    if (!patches->empty()) most = std::max<std::uint64_t>(most, *std::ranges::max_element(*patches));
  constexpr std::uint64_t limit = std::numeric_limits<std::uint32_t>::max();
  if (first_patch <= limit - most) return {};
  return {StatusCode::unsupported, "patch " + std::to_string(most) + " of a piece is number " +
                                       std::to_string(first_patch + most) + " of the whole, files hold up to " +
                                       std::to_string(limit)};
}

Status validate(const MeshAssembly& assembly) {
  for (std::size_t k = 0; k < assembly.shapes.size(); ++k) {
    const ShapeMesh& shape = assembly.shapes[k];
    if (shape.mesh.positions.empty() && shape.mesh.indices.empty() && shape.mesh.quads.empty()) continue;
    if (const Status status = validate(shape.mesh); !status.ok()) return in_item("shape", k, shape.name, status);
  }
  for (std::size_t k = 0; k < assembly.instances.size(); ++k) {
    const MeshInstance& instance = assembly.instances[k];
    if (const Status status = check_instance(instance, assembly.shapes.size()); !status.ok())
      return in_item("instance", k, instance.name, status);
  }
  return {};
}

}}  // namespace tessera::abi_0_1
