#pragma once
// Reads Patch, PatchMesh and NuPatch of a RIB file.

#include <vector>

#include "io/rib/rib_lexer.h"
#include "io/rib/rib_mesh.h"
#include "tessera/surface.h"

namespace tessera { inline namespace abi_0_1 {

/// The most points in one direction.
inline constexpr std::int64_t rib_count_limit = std::int64_t{1} << 30;

/// The text of a surface, after the word that asks for it.
struct RibSurfaceText {
  RibLexer& lexer;
  const TextCursor& begin;   ///< the request's place
  std::string_view request;  ///< its name
  const RibBasis &basis_u, &basis_v;

  Status failure(const std::string& sentence) const { return begin.failure(std::string(request) + ": " + sentence); }
};

// Readers; their errors name the line. The file's control points run along u first. A parameter list's P (x y z), Pw (w
// x, w y, w z, w) or Pz (z over x = u, y = v) is read and the rest ignored.

Result<std::vector<Surface>> read_patch(const RibSurfaceText& text);
Result<std::vector<Surface>> read_patch_mesh(const RibSurfaceText& text);
Result<std::vector<Surface>> read_nu_patch(const RibSurfaceText& text);

/// The variable's own name in a declaration such as "vertex point P".
std::string_view variable_name(std::string_view declaration);

}}  // namespace tessera::abi_0_1
