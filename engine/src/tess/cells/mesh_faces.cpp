#include "tess/cells/mesh_faces.h"

#include <new>
#include <string>
#include <utility>

#include "base/text.h"
#include "parallel/least_index.h"
#include "parallel/parallel_for.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

Status bad_face(const char* face, std::size_t place, const std::string& why) {
  return {StatusCode::invalid_argument, std::string(face) + " " + std::to_string(place) + " " + why,
          static_cast<std::ptrdiff_t>(place)};
}

/// The first of `indices` that is not below `limit`, or their number.
Result<std::size_t> first_beyond(std::span<const std::uint32_t> indices, std::size_t limit) {
  return find_first(indices.size(), [&](std::size_t begin, std::size_t end) {
    while (begin < end && indices[begin] < limit) ++begin;
    return begin;
  });
}

}  // namespace

Status check_face_corners(const char* face, std::span<const std::uint32_t> indices, std::size_t corners,
                          std::size_t vertices) {
  const Result<std::size_t> k = first_beyond(indices, vertices);
  if (!k || *k == indices.size()) return k.status();
  return bad_face(face, *k / corners,
                  "has the vertex " + std::to_string(indices[*k]) + ", there are " + std::to_string(vertices));
}

Status check_face_patches(const Mesh& mesh, std::size_t patches) {
  const auto check = [&](const char* face, std::span<const std::uint32_t> of, std::size_t faces) -> Status {
    if (of.size() != faces)
      return {StatusCode::count_mismatch, counted(of.size(), "patch", "patches") + " for " + counted(faces, face)};
    const Result<std::size_t> k = first_beyond(of, patches);
    if (!k || *k == of.size()) return k.status();
    return bad_face(face, *k, "is of patch " + std::to_string(of[*k]) + ", there are " + std::to_string(patches));
  };
  const Status status = check("triangle", mesh.patches, mesh.triangle_count());
  return status.ok() ? check("quad", mesh.quad_patches, mesh.quad_count()) : status;
}

std::vector<std::size_t> run_ends(std::span<const std::uint32_t> values) {
  constexpr std::size_t piece = std::size_t{1} << 16;
  std::vector<std::vector<std::size_t>> found(values.size() / piece + 1);
  const auto search = [&](std::size_t begin, std::size_t end) {
    std::vector<std::size_t>& ends = found[begin / piece];
    for (std::size_t k = begin; k < end; ++k)
      if (k + 1 == values.size() || values[k] != values[k + 1]) ends.push_back(k + 1);
  };
  if (!parallel_for(values.size(), piece, {}, search).ok()) throw std::bad_alloc();
  std::vector<std::size_t> all = std::move(found[0]);
  for (std::size_t k = 1; k < found.size(); ++k) all.insert(all.end(), found[k].begin(), found[k].end());
  return all;
}

}}  // namespace tessera::abi_0_1
