#include "occt/part_shape.h"

#include <opencascade/BRep_Tool.hxx>
#include <opencascade/Poly_Triangulation.hxx>
#include <opencascade/Standard_Failure.hxx>
#include <opencascade/Standard_OutOfMemory.hxx>
#include <opencascade/TopoDS.hxx>
#include <opencascade/TopoDS_Iterator.hxx>

#include <algorithm>
#include <new>
#include <utility>

#include "base/text.h"
#include "exact/transposed.h"
#include "exact/usable_edges.h"
#include "occt/face_loops.h"
#include "occt/face_surface.h"
#include "occt/guarded_calls.h"
#include "occt/occt_parameter.h"

namespace tessera { inline namespace abi_0_1 {

using opencascade::handle;

Result<PartShape> PartShape::make(const DescribedShape& file, const PlacedPart& placed, std::size_t first_face,
                                  const Execution& execution) {
  const TopoDS_Shape part = placed.shape.Located(TopLoc_Location());
  Result<ShapeEdges> edges = ShapeEdges::make(part, execution);
  if (!edges) return edges.status();
  PartShape out(file, placed, *std::move(edges));
  out.add_all(part, {placed.above, {}}, first_face);
  const auto own = file.names.find(identity(part));
  const std::string* const name = own != file.names.end() && !own->second.empty() ? &own->second : placed.above;
  if (name) out.shape_.name = *name;
  return out;
}

void PartShape::add_all(const TopoDS_Shape& shape, Wholes wholes, std::size_t first_face) {
  const auto name = file_->names.find(identity(shape));
  if (name != file_->names.end() && !name->second.empty()) wholes.name = &name->second;
  if (const Colour* const colour = placed_->colour_of(shape, *file_)) wholes.colour = *colour;
  switch (shape.ShapeType()) {
    case TopAbs_FACE: {
      PartFace& face = faces_.emplace_back();
      face.face = TopoDS::Face(shape);
      face.wholes = wholes;
      face.number = first_face + faces_.size() - 1;
      return;
    }
    case TopAbs_SOLID:
      wholes.solid = shape_.solid_count++;
      break;
    case TopAbs_SHELL:
      wholes.shell = static_cast<std::uint32_t>(shape_.shells.size());
      shape_.shells.push_back({{}, wholes.solid});
      break;
    default:
      break;
  }
  for (TopoDS_Iterator child(shape); child.More(); child.Next()) add_all(child.Value(), wholes, first_face);
}

/// The name of a face in messages: "face #51 (nut)".
std::string PartShape::words(const PartFace& face) const {
  const auto label = file_->labels.find(identity(face.face));
  const bool labelled = label != file_->labels.end() && !label->second.empty();
  return "face " + (labelled ? label->second : std::to_string(face.number)) +
         (face.wholes.name ? " (" + *face.wholes.name + ")" : "");
}

void PartShape::convert(std::size_t face) {
  PartFace& part_face = faces_[face];
  try {
    part_face.status = try_face(part_face);
  } catch (const Standard_OutOfMemory&) {
    throw std::bad_alloc();
  } catch (const Standard_Failure& failure) {
    part_face.status = status_of(failure);
  }
}

Status PartShape::try_face(PartFace& part_face) const {
  const TopoDS_Face& face = part_face.face;
  TopLoc_Location place;
  const handle<Geom_Surface> surface = BRep_Tool::Surface(face, place);
  if (surface.IsNull()) {
    const handle<Poly_Triangulation> mesh = BRep_Tool::Triangulation(face, place);
    const int count = mesh.IsNull() ? 0 : mesh->NbTriangles();
    return Status(StatusCode::unsupported,
                  "it has no surface" + (count == 0 ? "" : ", it is a mesh of " + counted(count, "triangle")));
  }
  FaceBorder border = face_border(face);
  border.fit_tolerance = file_->fit_tolerance;
  Result<FaceBox> box = face_box(border);
  if (!box) return box.status();
  const bool is_part = take_range(part_face, *box);
  Result<FaceSurface> made = face_surface(surface, box->domain, file_->spline_shift);
  if (!made) return made.status();
  Result<FaceLoops> loops = is_part ? FaceLoops{} : face_loops(border, *box, made->parameters, edges_);
  if (!loops) {
    part_face.whole.push_back(words(part_face) +
                              " is taken as untrimmed, its loops cannot be read: " + loops.status().message());
    loops = FaceLoops{};
  }
  if (loops->unshared)
    part_face.whole.push_back(words(part_face) +
                              " is read without shared edges: a curve of its border ends before its edge");
  const bool is_turned = face.Orientation() == TopAbs_REVERSED;
  if (is_turned)
    if (Status status = turn_around(made->surface, loops->loops); !status.ok()) return status;
  part_face.source = {face, occt_parameter(made->parameters.u), occt_parameter(made->parameters.v), is_turned};
  part_face.fit_error = made->fit_error;
  part_face.shift = made->shift;
  const std::string* const name = part_face.wholes.name;
  ShapeFace& out = part_face.made.emplace(
      ShapeFace{{name ? *name : std::string(), std::move(made->surface), affine(place.Transformation())}});
  (loops->whole ? out.outline : out.trims) = std::move(loops->loops);
  out.colour = part_face.wholes.colour;
  return {};
}

/// Cuts the box down to the range that the file states for a face without loops. Whether it became smaller.
bool PartShape::take_range(PartFace& face, FaceBox& box) const {
  const auto found = file_->ranges.find(identity(face.face));
  if (found == file_->ranges.end()) return false;
  const Domain &whole = box.domain, &stated = found->second;
  const Domain part{std::max(whole.u0, stated.u0), std::min(whole.u1, stated.u1), std::max(whole.v0, stated.v0),
                    std::min(whole.v1, stated.v1)};
  const double du = (part.u0 - whole.u0) + (whole.u1 - part.u1), dv = (part.v0 - whole.v0) + (whole.v1 - part.v1);
  if (du <= box.tolerance_u && dv <= box.tolerance_v) return false;
  if (part.u0 < part.u1 && part.v0 < part.v1) {
    box.domain = part;
    return true;
  }
  face.whole.push_back(words(face) + " is taken as the whole surface, its range is u from " + text(stated.u0) + " to " +
                       text(stated.u1) + ", v from " + text(stated.v0) + " to " + text(stated.v1));
  return false;
}

void PartShape::finish(Shape& shape, OcctShape& sources, Shortcomings& shortcomings) && {
  std::vector<std::size_t> kept;  // of each face of the shape, its place in the part
  for (std::size_t k = 0; k < faces_.size(); ++k) {
    PartFace& face = faces_[k];
    shortcomings.faces_whole.insert(shortcomings.faces_whole.end(), face.whole.size(), face.face);
    std::move(face.whole.begin(), face.whole.end(), std::back_inserter(shortcomings.whole));
    if (!face.status.ok()) {
      if (shortcomings.left_out.empty()) shortcomings.first_code = face.status.code();
      shortcomings.left_out.push_back(words(face) + " is left out: " + face.status.message());
      shortcomings.faces_left_out.push_back(face.face);
      continue;
    }
    shortcomings.fitted += face.fit_error > 0;
    shortcomings.fit_errors.push_back(face.fit_error);
    shortcomings.shifts.push_back(face.shift);
    shortcomings.worst_fit = std::max(shortcomings.worst_fit, face.fit_error);
    if (face.wholes.shell != no_id)
      shape_.shells[face.wholes.shell].faces.push_back(static_cast<std::uint32_t>(shape_.faces.size()));
    shape_.faces.push_back(*std::move(face.made));
    sources.faces.push_back(std::move(face.source));
    kept.push_back(k);
  }
  std::move(edges_).give_to(shape_, sources);
  for (const UnusableEdges& one : drop_unusable_edges(shape_)) {
    shortcomings.faces_whole.push_back(sources.faces[one.face].face);
    shortcomings.whole.push_back(words(faces_[kept[one.face]]) + " is read without shared edges: " + one.reason);
  }
  shape = std::move(shape_);
}

}}  // namespace tessera::abi_0_1
