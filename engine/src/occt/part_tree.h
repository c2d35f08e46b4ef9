#pragma once
// Finds the shapes of a file that are parts, and the places where they stand.

#include <opencascade/TopLoc_Location.hxx>
#include <opencascade/TopTools_MapOfShape.hxx>
#include <opencascade/gp_Trsf.hxx>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "occt/described_shape.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

Affine affine(const gp_Trsf& map);
/// A shape moved by a location, which may scale or mirror: OpenCASCADE's own call would throw.
TopoDS_Shape moved(TopoDS_Shape shape, const TopLoc_Location& location);

/// A part at its place. A part that a move mirrors is reversed, so that its normals keep their side.
struct PlacedPart {
  TopoDS_Shape shape;                  ///< with location and orientation in the file
  const std::string* above = nullptr;  ///< name of the nearest whole that has one and holds the part; null: none
  std::optional<Colour> colour;        ///< of the nearest whole that has one and holds the part
  std::string name;                    ///< of this instance; may be empty
  std::vector<const DescribedShape::Colours*>
      own_colours;  ///< of entities within this instance alone, the first ones first
  Affine move;      ///< after the location: scales and mirrors of mapped items

  /// The colour that the file states for an entity, at this instance or else everywhere; null if there is none.
  const Colour* colour_of(const TopoDS_Shape& entity, const DescribedShape& file) const;
};

/// Lists the parts of a file in their order. A part is as much of the file as stands together at each of its places:
/// whatever is no compound, and a compound without products, without moves and without shapes that stand at more places
/// than itself.
/// So no two parts share edges, except solids that a compound of products holds directly.
class PartTree {
 public:
  explicit PartTree(const DescribedShape& file) : file_(file) {}
  /// Errors: unsupported (more than `max_placed` shapes, each counted at each of its places: compounds that hold the
  /// same one twice, level over level, soon have more than any memory).
  Result<std::vector<PlacedPart>> parts();
  static constexpr std::size_t max_placed = std::size_t{1} << 22;

 private:
  std::size_t placed_shapes(const TopoDS_Shape& shape);
  void count_places(const TopoDS_Shape& shape);
  bool is_whole(const TopoDS_Shape& shape);
  void enter(const TopoDS_Shape& in_parent, const TopLoc_Location& parent, PlacedPart& above) const;
  void add_parts(const TopoDS_Shape& shape, const TopoDS_Shape& in_parent, const TopLoc_Location& parent,
                 PlacedPart above);

  const DescribedShape& file_;
  std::unordered_map<const void*, std::size_t> placed_;  ///< answers of placed_shapes()
  TopTools_MapOfShape seen_;
  std::unordered_map<const void*, int> places_;  ///< of each shape, the number of its locations in the file
  std::unordered_map<const void*, bool> whole_;  ///< answers of is_whole()
  std::vector<PlacedPart> parts_;
};

}}  // namespace tessera::abi_0_1
