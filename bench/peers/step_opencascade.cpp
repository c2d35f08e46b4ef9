#include "peers/step_opencascade.h"

#include <BRepBndLib.hxx>
#include <BRepGProp.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_ProgressRange.hxx>
#include <Poly_Triangulation.hxx>
#include <RWGltf_CafWriter.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <TColStd_IndexedDataMapOfStringString.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace tessera::bench {

struct StepDocument::Impl {
  opencascade::handle<TDocStd_Document> document;
  std::vector<TopoDS_Shape> shapes;  ///< the free ones, which hold all others

  template <class Act>
  void for_faces(Act&& act) const {
    for (const TopoDS_Shape& shape : shapes)
      for (TopExp_Explorer at(shape, TopAbs_FACE); at.More(); at.Next()) act(TopoDS::Face(at.Current()));
  }
};

StepDocument::StepDocument(const std::filesystem::path& file) : impl_(std::make_unique<Impl>()) {
  Message::DefaultMessenger()->ChangePrinters().Clear();
  XCAFApp_Application::GetApplication()->NewDocument("MDTV-XCAF", impl_->document);
  STEPCAFControl_Reader reader;
  reader.SetColorMode(true);
  reader.SetNameMode(true);
  if (reader.ReadFile(file.c_str()) != IFSelect_RetDone || !reader.Transfer(impl_->document))
    throw std::runtime_error("OpenCASCADE cannot read " + file.string());
  TDF_LabelSequence labels;
  XCAFDoc_DocumentTool::ShapeTool(impl_->document->Main())->GetFreeShapes(labels);
  for (const TDF_Label& label : labels) impl_->shapes.push_back(XCAFDoc_ShapeTool::GetShape(label));
}

StepDocument::~StepDocument() { XCAFApp_Application::GetApplication()->Close(impl_->document); }

std::size_t StepDocument::faces() const {
  std::size_t count = 0;
  impl_->for_faces([&](const TopoDS_Face&) { ++count; });
  return count;
}

double StepDocument::area() const {
  double area = 0;
  impl_->for_faces([&](const TopoDS_Face& face) {
    GProp_GProps properties;
    BRepGProp::SurfaceProperties(face, properties, 1e-5);
    area += std::abs(properties.Mass());
  });
  return area;
}

Box3 StepDocument::box() const {
  Bnd_Box box;
  for (const TopoDS_Shape& shape : impl_->shapes) BRepBndLib::AddOptimal(shape, box, false, false);
  if (box.IsVoid()) return {};
  const gp_Pnt lower = box.CornerMin(), upper = box.CornerMax();
  return {{lower.X(), lower.Y(), lower.Z()}, {upper.X(), upper.Y(), upper.Z()}};
}

std::size_t StepDocument::write_glb(double deflection, const std::filesystem::path& file) {
  for (const TopoDS_Shape& shape : impl_->shapes) BRepMesh_IncrementalMesh(shape, deflection);
  RWGltf_CafWriter writer(file.c_str(), true);
  if (!writer.Perform(impl_->document, TColStd_IndexedDataMapOfStringString(), Message_ProgressRange()))
    throw std::runtime_error("OpenCASCADE cannot write " + file.string());
  std::size_t triangles = 0;
  impl_->for_faces([&](const TopoDS_Face& face) {
    TopLoc_Location place;
    const opencascade::handle<Poly_Triangulation> made = BRep_Tool::Triangulation(face, place);
    if (!made.IsNull()) triangles += static_cast<std::size_t>(made->NbTriangles());
  });
  return triangles;
}

}  // namespace tessera::bench
