#pragma once
// A file as OpenCASCADE understands it.

#include <opencascade/TopoDS_Shape.hxx>
#include <opencascade/XSControl_Reader.hxx>
#include <string>
#include <unordered_map>
#include <vector>

#include "tessera/status.h"

namespace tessera::inline abi_0_1 {

/// Shapes, and what the file calls them. The maps' keys are the shapes' own identities (TShape), whatever their places.
struct CadFile {
  TopoDS_Shape shape;
  std::unordered_map<const void*, std::string> names;   ///< of products and entities
  std::unordered_map<const void*, std::string> labels;  ///< of faces: "#51" in STEP, "D113" in IGES
  std::vector<std::string> complaints;                  ///< of OpenCASCADE, about what it cannot make of the file
  std::string contents;                                 ///< for a file without faces: what else there is, or nothing
};

// Messages begin with `path`. OpenCASCADE's settings are changed, its messages taken away. Errors: parse_error.
// May throw Standard_Failure.
Result<CadFile> load_step(const std::string& path);
Result<CadFile> load_iges(const std::string& path);

// What both loaders share.

/// Takes OpenCASCADE's messages away from standard output; `last_failure` keeps the last that tells of a failure.
void take_messages(std::string& last_failure);
/// Sets millimetres; after the reader is made, whose making defines the settings.
void set_unit();
/// The shape, the labels and the complaints of what the reader has transferred.
CadFile transferred(const XSControl_Reader& reader);
/// The identity under which maps keep a shape; null for a null shape.
inline const void* identity(const TopoDS_Shape& shape) { return shape.IsNull() ? nullptr : shape.TShape().get(); }

}  // namespace tessera::inline abi_0_1
