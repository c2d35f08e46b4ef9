#pragma once
// A part of a file as a shape.

#include <string>
#include <vector>

#include "io_occt/cad_file.h"
#include "io_occt/part_tree.h"
#include "tessera/model.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Parts of a file that the model lacks or changes.
struct Shortcomings {
  std::vector<std::string> left_out;                ///< faces, one sentence each
  std::vector<std::string> whole;                   ///< faces whose loops or edges cannot be read
  StatusCode first_code = StatusCode::parse_error;  ///< of the first face that is left out
  std::size_t faces = 0;                            ///< seen so far
  std::size_t fitted = 0;                           ///< surfaces
  double worst_fit = 0;                             ///< their largest distance
};

/// Reads a part in its own space, wherever it is placed. Faces without a name are named after the whole that holds the
/// part, if that has one. May throw Standard_Failure.
Shape part_shape(const CadFile& file, const PlacedPart& placed, Shortcomings& shortcomings);

}}  // namespace tessera::abi_0_1
