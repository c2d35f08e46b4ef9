#pragma once
// OpenCASCADE's reading of STEP files into a document of its extended data framework, and their meshes as .glb.

#include <cstddef>
#include <filesystem>
#include <memory>

#include "tessera/geometry.h"

namespace tessera::bench {

/// A file as STEPCAFControl_Reader reads it, with names and colours.
class StepDocument {
 public:
  /// Reads a file. Throws std::runtime_error if OpenCASCADE cannot.
  explicit StepDocument(const std::filesystem::path& file);
  ~StepDocument();
  StepDocument(const StepDocument&) = delete;
  StepDocument& operator=(const StepDocument&) = delete;

  std::size_t faces() const;  ///< of all instances
  double area() const;        ///< of all faces, by BRepGProp
  Box3 box() const;           ///< of all shapes
  /// Meshes all shapes by BRepMesh_IncrementalMesh, at its own angle, and writes them by RWGltf_CafWriter. Once.
  /// Returns the number of triangles of all instances. Throws std::runtime_error if the file cannot be written.
  std::size_t write_glb(double deflection, const std::filesystem::path& file);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tessera::bench
