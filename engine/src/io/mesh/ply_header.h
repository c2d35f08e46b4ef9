#pragma once
// The header of a PLY file: which elements follow, and how their records are laid out.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

enum class PlyType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// In bytes, in a binary file.
std::size_t size_of(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;
  bool is_list = false;
  PlyType count_type = PlyType::uint8;  ///< of a list's length
};

/// Whether it holds the corners of a face; two names are in use.
bool is_corner_list(const PlyProperty& property);

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  bool binary = false;  ///< little endian; otherwise ascii
  std::vector<PlyElement> elements;
  std::size_t bytes = 0;  ///< of the header: the first record follows
};

/// Parses the header. Errors: parse_error, with the line; unsupported for big endian.
Result<PlyHeader> parse_ply_header(std::string_view bytes, std::string_view name);

}}  // namespace tessera::abi_0_1
