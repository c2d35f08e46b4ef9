#include "peers/trimmed_case.h"

#include <BRepBuilderAPI_Copy.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Iterator.hxx>
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <set>
#include <stdexcept>

#include "io_occt/cad_file.h"
#include "occt/shape_model.h"
#include "support/synthetic_sets.h"

namespace tessera::bench {
namespace {

void collect(const TopoDS_Shape& shape, TopAbs_ShapeEnum level, std::vector<TopoDS_Shape>& found) {
  if (shape.IsNull()) return;
  if (shape.ShapeType() >= level) return found.push_back(shape);
  for (TopoDS_Iterator child(shape); child.More(); child.Next()) collect(child.Value(), level, found);
}

/// Solids, or else shells and faces, each with a copy of its own.
TopoDS_Shape expanded(const TopoDS_Shape& shape) {
  std::vector<TopoDS_Shape> parts;
  collect(shape, TopAbs_SOLID, parts);
  BRep_Builder builder;
  TopoDS_Compound all;
  builder.MakeCompound(all);
  for (const TopoDS_Shape& part : parts) builder.Add(all, BRepBuilderAPI_Copy(part).Shape());
  return all;
}

template <class T>
T value_or_throw(Result<T> result) {
  if (!result) throw std::runtime_error(result.status().message());
  return *std::move(result);
}

DescribedShape load(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::ranges::transform(ending, ending.begin(), [](char c) { return static_cast<char>(std::tolower(c)); });
  const bool step = ending == ".stp" || ending == ".step", iges = ending == ".igs" || ending == ".iges";
  return value_or_throw(step ? load_step(file.string()) : iges ? load_iges(file.string()) : load_brep(file.string()));
}

void check_same(const ModelSurface& surface, const TrueFace& face) {
  const Domain& box = face.box();
  for (const double s : {0.1, 0.45, 0.8})
    for (const double t : {0.15, 0.5, 0.85}) {
      const Parameters at{box.u0 + s * (box.u1 - box.u0), box.v0 + t * (box.v1 - box.v0)};
      const Parameters ours = face.ours(at);
      const Vec3 p = face.point(at), q = test::value_of(evaluate_jet(surface, ours[0], ours[1])).position;
      if (!(length(p - q) <= 1e-6 * (1 + length(p)))) throw std::runtime_error("a surface is not that of its face");
    }
}

}  // namespace

std::size_t TrimmedCase::trimmed_faces() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(model.surfaces, [](const ModelSurface& s) { return !s.trims->empty(); }));
}

TrimmedCase read_case(const std::filesystem::path& file, bool expands) {
  DescribedShape cad = load(file);
  TrimmedCase one;
  one.name = file.filename().string();
  one.as_read = cad.shape;
  std::vector<TopoDS_Shape> faces;
  collect(cad.shape, TopAbs_FACE, faces);
  std::set<const void*> distinct;
  std::erase_if(faces, [](const TopoDS_Shape& shape) { return shape.ShapeType() != TopAbs_FACE; });
  for (const TopoDS_Shape& face : faces) distinct.insert(face.TShape().get());
  one.distinct_faces = distinct.size();
  if (expands && distinct.size() < faces.size()) cad.shape = expanded(cad.shape);
  one.shape = cad.shape;
  one.model = value_or_throw(model_of(cad, one.name)).model;
  faces.clear();
  collect(one.shape, TopAbs_FACE, faces);
  for (const TopoDS_Shape& shape : faces) {
    if (shape.ShapeType() != TopAbs_FACE) continue;
    const TopoDS_Face face = TopoDS::Face(shape);
    TopLoc_Location place;
    const Handle(Geom_Surface) surface = BRep_Tool::Surface(face, place);
    const Result<FaceBox> box = face_box(face_border(face));
    if (!box) continue;
    const Result<FaceSurface> made = face_surface(surface, box->domain);
    if (!made) continue;
    one.faces.push_back(std::make_unique<TrueFace>(face, *box, made->parameters));
    one.fit_errors.push_back(made->fit_error);
  }
  if (one.faces.size() != one.model.surfaces.size()) throw std::runtime_error("faces were left out");
  for (std::size_t k = 0; k < one.faces.size(); ++k) check_same(one.model.surfaces[k], *one.faces[k]);
  return one;
}

}  // namespace tessera::bench
