#pragma once
// A shape of OpenCASCADE, and what a file states of its parts.

#include <opencascade/NCollection_DataMap.hxx>
#include <opencascade/TopTools_ShapeMapHasher.hxx>
#include <opencascade/TopoDS_Shape.hxx>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "exact/thinned_spline.h"
#include "tessera/colour.h"
#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

/// A shape, and names, colours and places of its parts, which files state. The keys of the maps are the identities of
/// shapes (TShape), independent of placement.
struct DescribedShape {
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
  /// How far along the surface a border may move where its curves are fitted, a length; 0: by rounding alone.
  double fit_tolerance = 0;
  SplineShift spline_shift;  ///< how far splines of many spans may move to get fewer; 0: not at all
  std::string contents;      ///< for a file without faces: what it holds instead, or empty
};

/// The key of a shape in the maps; null for a null shape.
inline const void* identity(const TopoDS_Shape& shape) { return shape.IsNull() ? nullptr : shape.TShape().get(); }

}}  // namespace tessera::abi_0_1
