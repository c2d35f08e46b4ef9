#pragma once
// A CAD file, read once by OpenCASCADE: as its shape, and as a model of Tessera.

#include <TopoDS_Shape.hxx>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "peers/true_face.h"
#include "tessera/model.h"

namespace tessera::bench {

struct TrimmedCase {
  std::string name;
  TopoDS_Shape as_read;                          ///< instances share faces
  TopoDS_Shape shape;                            ///< each instance has faces of its own; as_read if none is shared
  std::size_t distinct_faces = 0;                ///< of as_read
  Model model;                                   ///< surface k is faces[k]
  std::vector<std::unique_ptr<TrueFace>> faces;  ///< in `shape`
  std::vector<double> fit_errors;                ///< how far each surface of the model lies from that of its face
  std::size_t trimmed_faces() const;
};

/// Reads a file and checks that surfaces and faces have the same points. `expands`: whether instances get faces of
/// their own; otherwise `shape` is `as_read`. Throws std::runtime_error, Standard_Failure.
TrimmedCase read_case(const std::filesystem::path& file, bool expands = true);

}  // namespace tessera::bench
