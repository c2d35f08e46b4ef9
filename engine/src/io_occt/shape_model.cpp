#include "io_occt/shape_model.h"

#include <opencascade/BRep_Tool.hxx>
#include <opencascade/Standard_Failure.hxx>
#include <opencascade/Standard_OutOfMemory.hxx>
#include <opencascade/TopoDS.hxx>
#include <opencascade/TopoDS_Face.hxx>
#include <opencascade/TopoDS_Iterator.hxx>
#include <opencascade/gp_Trsf.hxx>

#include <algorithm>
#include <utility>

#include "base/text.h"
#include "io_occt/face_loops.h"
#include "io_occt/face_surface.h"

namespace tessera::inline abi_0_1 {
namespace {

using opencascade::handle;

Affine affine(const gp_Trsf& map) {
  const auto column = [&](int k) { return Vec3{map.Value(1, k), map.Value(2, k), map.Value(3, k)}; };
  return {.columns = {column(1), column(2), column(3)}, .translation = column(4)};
}

/// Swaps u and v, which turns the normal around.
Result<BSplineSurface> transposed(const BSplineSurface& s) {
  std::vector<Vec3> points;
  std::vector<double> weights;
  for (std::size_t j = 0; j < s.count_v(); ++j)
    for (std::size_t i = 0; i < s.count_u(); ++i) {
      points.push_back(s.point(i, j));
      weights.push_back(s.weight(i, j));
    }
  const Domain& d = s.domain();
  return BSplineSurface::rational(s.degree_v(), s.knots_v(), s.degree_u(), s.knots_u(), points, weights,
                                  Domain{d.v0, d.v1, d.u0, d.u1});
}

Result<Curve> transposed(const Curve& curve) {
  std::vector<Vec3> points(curve.points().begin(), curve.points().end());
  for (Vec3& p : points) std::swap(p.x, p.y);
  return curve.is_rational() ? Curve::nurbs(curve.degree(), points, curve.weights(), curve.knots(), curve.domain())
                             : Curve::b_spline(curve.degree(), points, curve.knots(), curve.domain());
}

Status transpose(BSplineSurface& surface, std::vector<TrimLoop>& loops) {
  Result<BSplineSurface> swapped = transposed(surface);
  if (!swapped) return swapped.status();
  surface = *std::move(swapped);
  for (TrimLoop& loop : loops)
    for (Curve& curve : loop.curves) {
      Result<Curve> turned = transposed(curve);
      if (!turned) return turned.status();
      curve = *std::move(turned);
    }
  return {};
}

/// Gathers faces and their warnings.
class ModelOfFaces {
 public:
  ModelOfFaces(const CadFile& file, const std::string& path) : file_(file), path_(path) {}

  /// Adds the faces of `shape`; `name` is the name of the whole that it belongs to.
  void add_all(const TopoDS_Shape& shape, const std::string* name) {
    if (shape.IsNull()) return;
    const auto own = file_.names.find(identity(shape));
    if (own != file_.names.end() && !own->second.empty()) name = &own->second;
    if (shape.ShapeType() == TopAbs_FACE) return add_face(TopoDS::Face(shape), name ? *name : std::string());
    for (TopoDS_Iterator child(shape); child.More(); child.Next()) add_all(child.Value(), name);
  }

  Result<Model> finish() {
    for (const std::string& complaint : file_.complaints) left_out_.push_back("OpenCASCADE: " + complaint);
    if (model_.surfaces.empty()) return nothing();
    warn_of(left_out_);
    warn_of(whole_);
    if (fitted_ > 0) warn(counted(fitted_, "surface") + " fitted by splines, to within " + text(worst_fit_) + " mm");
    return std::move(model_);
  }

 private:
  void warn_of(const std::vector<std::string>& sentences) {
    const std::size_t most = 20;
    for (std::size_t k = 0; k < std::min(most, sentences.size()); ++k) warn(sentences[k]);
    if (sentences.size() > most) warn(counted(sentences.size() - most, "message") + " more of this kind");
  }

  void warn(const std::string& sentence) { model_.warnings.push_back(path_ + ": " + sentence); }

  Status nothing() {
    if (left_out_.empty()) {
      const std::string& contents = file_.contents;
      return Status(StatusCode::parse_error,
                    path_ + ": it holds no surfaces" + (contents.empty() ? "" : " (" + contents + ")"));
    }
    const std::size_t more = left_out_.size() - 1;
    const std::string others = more == 0 ? "" : " (and " + counted(more, "message") + " more)";
    return Status(first_code_, path_ + ": no surface can be read: " + left_out_[0] + others);
  }

  void add_face(const TopoDS_Face& face, const std::string& name) {
    ++faces_;
    Status status;
    try {
      status = try_face(face, name);
    } catch (const Standard_OutOfMemory&) {
      throw std::bad_alloc();
    } catch (const Standard_Failure& failure) {
      status = Status(StatusCode::internal, std::string("OpenCASCADE: ") + failure.GetMessageString());
    }
    if (status.ok()) return;
    if (left_out_.empty()) first_code_ = status.code();
    left_out_.push_back(words(face, name) + " is left out: " + status.message());
  }

  /// "face #51 (nut)".
  std::string words(const TopoDS_Face& face, const std::string& name) const {
    const auto label = file_.labels.find(identity(face));
    const bool labelled = label != file_.labels.end() && !label->second.empty();
    return "face " + (labelled ? label->second : std::to_string(faces_ - 1)) + (name.empty() ? "" : " (" + name + ")");
  }

  Status try_face(const TopoDS_Face& face, const std::string& name) {
    TopLoc_Location place;
    const handle<Geom_Surface> surface = BRep_Tool::Surface(face, place);
    if (surface.IsNull()) return Status(StatusCode::unsupported, "it has no surface");
    const Result<FaceBox> box = face_box(face);
    if (!box) return box.status();
    Result<FaceSurface> made = face_surface(surface, box->domain);
    if (!made) return made.status();
    Result<std::vector<TrimLoop>> loops = face_loops(face, *box, made->parameters);
    if (!loops) {
      whole_.push_back(words(face, name) +
                       " is taken as untrimmed, its loops cannot be read: " + loops.status().message());
      loops = std::vector<TrimLoop>();
    }
    if (face.Orientation() == TopAbs_REVERSED)
      if (Status status = transpose(made->surface, *loops); !status.ok()) return status;
    fitted_ += made->fit_error > 0;
    worst_fit_ = std::max(worst_fit_, made->fit_error);
    model_.surfaces.push_back({name, std::move(made->surface), affine(place.Transformation()), *std::move(loops)});
    return {};
  }

  const CadFile& file_;
  const std::string& path_;
  Model model_;
  std::vector<std::string> left_out_;
  std::vector<std::string> whole_;  ///< faces whose loops are bad
  StatusCode first_code_ = StatusCode::parse_error;
  std::size_t faces_ = 0, fitted_ = 0;
  double worst_fit_ = 0;
};

}  // namespace

Result<Model> model_of(const CadFile& file, const std::string& path) {
  ModelOfFaces faces(file, path);
  faces.add_all(file.shape, nullptr);
  return faces.finish();
}

}  // namespace tessera::inline abi_0_1
