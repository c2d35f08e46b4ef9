#pragma once
// A file as OpenCASCADE reads it.

#include <opencascade/Interface_InterfaceModel.hxx>
#include <opencascade/NCollection_DataMap.hxx>
#include <opencascade/Quantity_Color.hxx>
#include <opencascade/TopTools_ShapeMapHasher.hxx>
#include <opencascade/TopoDS_Shape.hxx>
#include <opencascade/XSControl_Reader.hxx>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "tessera/brep.h"
#include "tessera/geometry.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Shapes, and their names in the file. The keys of the maps are the identities of shapes (TShape), independent of
/// placement.
struct CadFile {
  using Colours = std::unordered_map<const void*, Colour>;
  TopoDS_Shape shape;
  std::unordered_map<const void*, std::string> names;   ///< of products and entities
  std::unordered_map<const void*, std::string> labels;  ///< of faces: "#51" in STEP, "D113" in IGES
  Colours colours;                                      ///< of entities
  std::unordered_map<const void*, Domain> ranges;       ///< of faces without loops, which may be parts of their surface
  std::unordered_set<const void*> products;             ///< parts and assemblies of parts
  // For parts in an assembly; the key is the part at its place in the assembly that holds it.
  template <class T>
  using OfInstances = NCollection_DataMap<TopoDS_Shape, T, TopTools_ShapeMapHasher>;
  OfInstances<std::string> instance_names;
  OfInstances<Colours> instance_colours;  ///< of entities within this instance alone, before `colours`
  OfInstances<Affine> moves;              ///< in the assembly's space, after the instance's location: scales, mirrors
  std::string unit, file_unit;            ///< of lengths: as read, and as the file states them
  std::vector<std::string> complaints;    ///< OpenCASCADE's messages about parts that it cannot read
  std::vector<std::string> notes;         ///< what else the model lacks or changes, one sentence each
  std::string contents;                   ///< for a file without faces: what it holds instead, or empty
};

// Loads a file. Messages begin with `path`. Changes OpenCASCADE's settings and diverts its messages. Errors:
// parse_error, io_error. May throw Standard_Failure.
Result<CadFile> load_step(const std::string& path);
Result<CadFile> load_iges(const std::string& path);
Result<CadFile> load_brep(const std::string& path);

// Shared by the loaders.

/// Diverts OpenCASCADE's messages from standard output; `last_failure` keeps the last that reports a failure.
void take_messages(std::string& last_failure);
/// Sets millimetres. Call it after making the reader, which defines the settings.
void set_unit();
/// The shape, the labels and the complaints of what the reader has transferred.
CadFile transferred(const XSControl_Reader& reader);
/// The label of an entity, such as "#51" or "D113"; empty if the model does not hold it.
std::string label_of(const Interface_InterfaceModel& model, const opencascade::handle<Standard_Transient>& entity);
/// A colour of OpenCASCADE's, which are linear, in sRGB.
Colour colour_of(const Quantity_Color& colour, double alpha);
/// The key of a shape in the maps; null for a null shape.
inline const void* identity(const TopoDS_Shape& shape) { return shape.IsNull() ? nullptr : shape.TShape().get(); }

}}  // namespace tessera::abi_0_1
