#include "occt/shape_model.h"

#include <opencascade/BRep_Tool.hxx>
#include <opencascade/Poly_Triangulation.hxx>
#include <opencascade/Standard_Failure.hxx>
#include <opencascade/Standard_OutOfMemory.hxx>
#include <opencascade/TopoDS.hxx>
#include <opencascade/TopoDS_Face.hxx>
#include <opencascade/TopoDS_Iterator.hxx>

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "base/text.h"
#include "exact/transposed.h"
#include "exact/usable_edges.h"
#include "occt/face_loops.h"
#include "occt/face_surface.h"
#include "occt/part_tree.h"
#include "occt/shape_edges.h"
#include "tessera/topology.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

std::string in_file(const std::string& path, const std::string& sentence) {
  return path.empty() ? sentence : path + ": " + sentence;
}

// A part of a file as a shape.

/// Parts of a file that the model lacks or changes.
struct Shortcomings {
  std::vector<std::string> left_out;                ///< faces, one sentence each
  std::vector<std::string> whole;                   ///< faces whose loops or edges cannot be read
  StatusCode first_code = StatusCode::parse_error;  ///< of the first face that is left out
  std::size_t faces = 0;                            ///< seen so far
  std::size_t fitted = 0;                           ///< surfaces
  double worst_fit = 0;                             ///< their largest distance
};

using opencascade::handle;

/// Name, colour, shell and solid of the wholes that hold a face.
struct Wholes {
  const std::string* name = nullptr;
  std::optional<Colour> colour;
  std::uint32_t shell = no_id, solid = no_id;
};

/// Gathers the faces of one part.
class PartShape {
 public:
  PartShape(const DescribedShape& file, const TopoDS_Shape& part, const PlacedPart& placed, Shortcomings& shortcomings)
      : file_(file), placed_(placed), edges_(part), shortcomings_(shortcomings) {}

  void add_all(const TopoDS_Shape& shape, Wholes wholes) {
    const auto name = file_.names.find(identity(shape));
    if (name != file_.names.end() && !name->second.empty()) wholes.name = &name->second;
    if (const Colour* const colour = placed_.colour_of(shape, file_)) wholes.colour = *colour;
    switch (shape.ShapeType()) {
      case TopAbs_FACE:
        return add_face(TopoDS::Face(shape), wholes);
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
    for (TopoDS_Iterator child(shape); child.More(); child.Next()) add_all(child.Value(), wholes);
  }

  Shape finish(const std::string* above) && {
    std::move(edges_).give_to(shape_);
    if (above) shape_.name = *above;
    for (const UnusableEdges& one : drop_unusable_edges(shape_))
      shortcomings_.whole.push_back(words_[one.face] + " is read without shared edges: " + one.reason);
    return std::move(shape_);
  }

 private:
  void add_face(const TopoDS_Face& face, const Wholes& wholes) {
    ++shortcomings_.faces;
    const std::string name = wholes.name ? *wholes.name : std::string();
    Status status;
    try {
      status = try_face(face, name, wholes);
    } catch (const Standard_OutOfMemory&) {
      throw std::bad_alloc();
    } catch (const Standard_Failure& failure) {
      status = Status(StatusCode::internal, std::string("OpenCASCADE: ") + failure.GetMessageString());
    }
    if (status.ok()) return;
    if (shortcomings_.left_out.empty()) shortcomings_.first_code = status.code();
    shortcomings_.left_out.push_back(words(face, name) + " is left out: " + status.message());
  }

  /// "face #51 (nut)".
  std::string words(const TopoDS_Face& face, const std::string& name) const {
    const auto label = file_.labels.find(identity(face));
    const bool labelled = label != file_.labels.end() && !label->second.empty();
    return "face " + (labelled ? label->second : std::to_string(shortcomings_.faces - 1)) +
           (name.empty() ? "" : " (" + name + ")");
  }

  Status try_face(const TopoDS_Face& face, const std::string& name, const Wholes& wholes) {
    TopLoc_Location place;
    const handle<Geom_Surface> surface = BRep_Tool::Surface(face, place);
    if (surface.IsNull()) {
      const handle<Poly_Triangulation> mesh = BRep_Tool::Triangulation(face, place);
      const int count = mesh.IsNull() ? 0 : mesh->NbTriangles();
      return Status(StatusCode::unsupported,
                    "it has no surface" + (count == 0 ? "" : ", it is a mesh of " + counted(count, "triangle")));
    }
    Result<FaceBox> box = face_box(face);
    if (!box) return box.status();
    const bool is_part = take_range(face, name, *box);
    Result<FaceSurface> made = face_surface(surface, box->domain);
    if (!made) return made.status();
    Result<FaceLoops> loops = is_part ? FaceLoops{} : face_loops(face, *box, made->parameters, edges_);
    if (!loops) {
      shortcomings_.whole.push_back(words(face, name) +
                                    " is taken as untrimmed, its loops cannot be read: " + loops.status().message());
      loops = FaceLoops{};
    }
    if (loops->unshared)
      shortcomings_.whole.push_back(words(face, name) +
                                    " is read without shared edges: a curve of its border ends before its edge");
    if (face.Orientation() == TopAbs_REVERSED)
      if (Status status = turn_around(made->surface, loops->loops); !status.ok()) return status;
    shortcomings_.fitted += made->fit_error > 0;
    shortcomings_.worst_fit = std::max(shortcomings_.worst_fit, made->fit_error);
    if (wholes.shell != no_id)
      shape_.shells[wholes.shell].faces.push_back(static_cast<std::uint32_t>(shape_.faces.size()));
    ShapeFace& out =
        shape_.faces.emplace_back(ShapeFace{{name, std::move(made->surface), affine(place.Transformation())}});
    (loops->whole ? out.outline : out.trims) = std::move(loops->loops);
    out.colour = wholes.colour;
    words_.push_back(words(face, name));
    return {};
  }

  /// Cuts the box down to the range that the file states for a face without loops. Whether it became smaller.
  bool take_range(const TopoDS_Face& face, const std::string& name, FaceBox& box) {
    const auto found = file_.ranges.find(identity(face));
    if (found == file_.ranges.end()) return false;
    const Domain &whole = box.domain, &stated = found->second;
    const Domain part{std::max(whole.u0, stated.u0), std::min(whole.u1, stated.u1), std::max(whole.v0, stated.v0),
                      std::min(whole.v1, stated.v1)};
    const double du = (part.u0 - whole.u0) + (whole.u1 - part.u1), dv = (part.v0 - whole.v0) + (whole.v1 - part.v1);
    if (du <= box.tolerance_u && dv <= box.tolerance_v) return false;
    if (part.u0 < part.u1 && part.v0 < part.v1) {
      box.domain = part;
      return true;
    }
    shortcomings_.whole.push_back(words(face, name) + " is taken as the whole surface, its range is u from " +
                                  text(stated.u0) + " to " + text(stated.u1) + ", v from " + text(stated.v0) + " to " +
                                  text(stated.v1));
    return false;
  }

  const DescribedShape& file_;
  const PlacedPart& placed_;
  ShapeEdges edges_;
  Shortcomings& shortcomings_;
  Shape shape_;
  std::vector<std::string> words_;  ///< what messages call each face of the shape
};

/// Reads a part in its own space, wherever it is placed. Faces without a name are named after the whole that holds the
/// part, if that has one. May throw Standard_Failure.
Shape part_shape(const DescribedShape& file, const PlacedPart& placed, Shortcomings& shortcomings) {
  const TopoDS_Shape part = placed.shape.Located(TopLoc_Location());
  PartShape faces(file, part, placed, shortcomings);
  faces.add_all(part, {placed.above, {}});
  const auto own = file.names.find(identity(part));
  return std::move(faces).finish(own != file.names.end() && !own->second.empty() ? &own->second : placed.above);
}

/// Gathers parts, their places, and warnings.
class ModelOfParts {
 public:
  ModelOfParts(const DescribedShape& file, const std::string& path) : file_(file), path_(path) {}

  void add(const PlacedPart& placed) {
    const std::uint32_t shape = shape_of(placed);
    if (shape == no_id) return;
    Instance& instance = model_.instances.emplace_back();
    instance.shape = shape;
    instance.first_surface = surfaces_;
    surfaces_ += model_.shapes[shape].faces.size();
    instance.name = placed.name.empty() ? *model_.shapes[shape].name : placed.name;
    instance.placement = placed.move * affine(placed.shape.Location().Transformation());
    instance.colour = placed.colour;
  }

  Result<Model> finish() {
    std::vector<std::string>& left_out = shortcomings_.left_out;
    for (const std::string& complaint : file_.complaints) left_out.push_back("OpenCASCADE: " + complaint);
    if (model_.instances.empty()) return nothing();
    warn_of(left_out);
    warn_of(shortcomings_.whole);
    warn_of(file_.notes);
    if (shortcomings_.fitted > 0)
      warn(counted(shortcomings_.fitted, "surface") + " fitted by splines, to within " + text(shortcomings_.worst_fit) +
           " mm");
    Result<std::vector<ModelSurface>> placed = placed_faces(model_.shapes, model_.instances);
    if (!placed) return placed.status();
    model_.surfaces = *std::move(placed);
    model_.unit = file_.unit;
    model_.file_unit = file_.file_unit;
    return std::move(model_);
  }

 private:
  /// The shape of a part, which is read where it comes first; no_id if it has no faces.
  std::uint32_t shape_of(const PlacedPart& placed) {
    const auto own = file_.names.find(identity(placed.shape));
    const bool named = own != file_.names.end() && !own->second.empty();
    const auto [place, is_new] = shapes_.try_emplace(
        {identity(placed.shape), placed.shape.Orientation(), named ? nullptr : placed.above, placed.own_colours},
        no_id);
    if (!is_new) return place->second;
    Shape shape = part_shape(file_, placed, shortcomings_);
    if (shape.faces.empty()) return no_id;
    place->second = static_cast<std::uint32_t>(model_.shapes.size());
    model_.shapes.push_back(std::move(shape));
    return place->second;
  }

  void warn_of(const std::vector<std::string>& sentences) {
    const std::size_t most = 20;
    for (std::size_t k = 0; k < std::min(most, sentences.size()); ++k) warn(sentences[k]);
    if (sentences.size() > most) warn(counted(sentences.size() - most, "message") + " more of this kind");
  }

  void warn(const std::string& sentence) { model_.warnings.push_back(in_file(path_, sentence)); }

  Status nothing() {
    const std::vector<std::string>& left_out = shortcomings_.left_out;
    const std::string& contents = file_.contents;
    if (left_out.empty())
      return Status(StatusCode::parse_error,
                    in_file(path_, "it holds no surfaces" + (contents.empty() ? "" : " (" + contents + ")")));
    const std::size_t more = left_out.size() - 1;
    const std::string others = more == 0 ? "" : " (and " + counted(more, "message") + " more)";
    return Status(shortcomings_.first_code,
                  in_file(path_, "no surface can be read: " + left_out[0] + others +
                                     (contents.empty() ? "" : "; the file holds " + contents)));
  }

  const DescribedShape& file_;
  const std::string& path_;
  Model model_;
  std::size_t surfaces_ = 0;  ///< of all instances so far
  /// By identity, orientation, the name that faces without one take, and the colours of this instance alone.
  std::map<std::tuple<const void*, int, const std::string*, std::vector<const DescribedShape::Colours*>>, std::uint32_t>
      shapes_;
  Shortcomings shortcomings_;
};

}  // namespace

Result<Model> model_of(const DescribedShape& file, const std::string& path) {
  ModelOfParts parts(file, path);
  for (const PlacedPart& part : PartTree(file).parts()) parts.add(part);
  return parts.finish();
}

}}  // namespace tessera::abi_0_1
