#include "occt/part_tree.h"

#include <opencascade/Standard_Version.hxx>
#include <opencascade/TopoDS_Iterator.hxx>

#include <utility>

namespace tessera { inline namespace abi_0_1 {

Affine affine(const gp_Trsf& map) {
  const auto column = [&](int k) { return Vec3{map.Value(1, k), map.Value(2, k), map.Value(3, k)}; };
  return {.columns = {column(1), column(2), column(3)}, .translation = column(4)};
}

TopoDS_Shape moved(TopoDS_Shape shape, const TopLoc_Location& location) {
#if OCC_VERSION_HEX >= 0x070600
  shape.Location(location * shape.Location(), false);
#else
  shape.Location(location * shape.Location());
#endif
  return shape;
}

const Colour* PlacedPart::colour_of(const TopoDS_Shape& entity, const DescribedShape& file) const {
  for (const DescribedShape::Colours* const own : own_colours)
    if (const auto found = own->find(identity(entity)); found != own->end()) return &found->second;
  const auto found = file.colours.find(identity(entity));
  return found == file.colours.end() ? nullptr : &found->second;
}

Result<std::vector<PlacedPart>> PartTree::parts() {
  if (!file_.shape.IsNull()) {
    if (placed_shapes(file_.shape) > max_placed)
      return Status(StatusCode::unsupported,
                    "it holds more than " + std::to_string(max_placed) +
                        " faces, shells, solids and compounds, counted at each of their places");
    count_places(file_.shape);
    add_parts(file_.shape, file_.shape, {}, {});
  }
  return std::move(parts_);
}

/// How many shapes the shape has, down to faces and with itself, each counted as often as it is held; beyond the limit,
/// any number above it.
std::size_t PartTree::placed_shapes(const TopoDS_Shape& shape) {
  if (shape.ShapeType() >= TopAbs_FACE) return 1;
  const auto known = placed_.find(identity(shape));
  if (known != placed_.end()) return known->second;
  std::size_t count = 1;
  for (TopoDS_Iterator child(shape, false, false); child.More() && count <= max_placed; child.Next())
    count += placed_shapes(child.Value());
  placed_[identity(shape)] = count;
  return count;
}

void PartTree::count_places(const TopoDS_Shape& shape) {
  if (!seen_.Add(shape)) return;
  ++places_[identity(shape)];
  if (shape.ShapeType() == TopAbs_FACE) return;
  for (TopoDS_Iterator child(shape); child.More(); child.Next()) count_places(child.Value());
}

/// Whether the shape holds neither products nor shapes that stand at more places.
bool PartTree::is_whole(const TopoDS_Shape& shape) {
  const auto known = whole_.find(identity(shape));
  if (known != whole_.end()) return known->second;
  bool whole = true;
  const int places = places_[identity(shape)];
  if (shape.ShapeType() != TopAbs_FACE)
    for (TopoDS_Iterator child(shape, false, false); child.More() && whole; child.Next()) {
      const TopoDS_Shape& part = child.Value();
      whole = places_[identity(part)] == places && !file_.products.contains(identity(part)) &&
              !file_.moves.IsBound(part) && !file_.instance_colours.IsBound(part) && is_whole(part);
    }
  whole_[identity(shape)] = whole;
  return whole;
}

/// Adds what the file states of an instance to what it states of the wholes that hold it.
void PartTree::enter(const TopoDS_Shape& in_parent, const TopLoc_Location& parent, PlacedPart& above) const {
  if (const std::string* const name = file_.instance_names.Seek(in_parent)) above.name = *name;
  if (const DescribedShape::Colours* const own = file_.instance_colours.Seek(in_parent))
    above.own_colours.push_back(own);
  if (const Affine* const move = file_.moves.Seek(in_parent))
    above.move = above.move * affine(parent.Transformation()) * *move * affine(parent.Inverted().Transformation());
}

void PartTree::add_parts(const TopoDS_Shape& shape, const TopoDS_Shape& in_parent, const TopLoc_Location& parent,
                         PlacedPart above) {
  enter(in_parent, parent, above);
  if (shape.ShapeType() != TopAbs_COMPOUND || is_whole(shape)) {
    above.shape = above.move.determinant() < 0 ? shape.Reversed() : shape;
    parts_.push_back(std::move(above));
    return;
  }
  const auto name = file_.names.find(identity(shape));
  if (name != file_.names.end() && !name->second.empty()) above.above = &name->second;
  if (const Colour* const colour = above.colour_of(shape, file_)) above.colour = *colour;
  TopoDS_Iterator in_place(shape), in_shape(shape, false, false);
  for (; in_place.More(); in_place.Next(), in_shape.Next())
    add_parts(in_place.Value(), in_shape.Value(), shape.Location(), above);
}

}}  // namespace tessera::abi_0_1
