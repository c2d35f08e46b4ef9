#include "io_occt/part_tree.h"

#include <opencascade/TopoDS_Iterator.hxx>

#include <utility>

namespace tessera::inline abi_0_1 {

std::vector<PlacedPart> PartTree::parts() {
  if (!file_.shape.IsNull()) {
    count_places(file_.shape);
    add_parts(file_.shape, file_.shape, {});
  }
  return std::move(parts_);
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
      whole = places_[identity(part)] == places && !file_.products.contains(identity(part)) && is_whole(part);
    }
  whole_[identity(shape)] = whole;
  return whole;
}

void PartTree::add_parts(const TopoDS_Shape& shape, const TopoDS_Shape& in_parent, PlacedPart above) {
  if (const std::string* const name = file_.instance_names.Seek(in_parent)) above.name = *name;
  if (shape.ShapeType() != TopAbs_COMPOUND || is_whole(shape)) {
    above.shape = shape;
    parts_.push_back(std::move(above));
    return;
  }
  const auto name = file_.names.find(identity(shape));
  if (name != file_.names.end() && !name->second.empty()) above.above = &name->second;
  const auto colour = file_.colours.find(identity(shape));
  if (colour != file_.colours.end()) above.colour = colour->second;
  TopoDS_Iterator in_place(shape), in_shape(shape, false, false);
  for (; in_place.More(); in_place.Next(), in_shape.Next()) add_parts(in_place.Value(), in_shape.Value(), above);
}

}  // namespace tessera::inline abi_0_1
