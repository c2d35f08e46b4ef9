// STEP through OpenCASCADE.

#include <opencascade/STEPControl_Reader.hxx>
#include <opencascade/StepBasic_Product.hxx>
#include <opencascade/StepBasic_ProductDefinition.hxx>
#include <opencascade/StepBasic_ProductDefinitionFormation.hxx>
#include <opencascade/StepShape_ShapeRepresentation.hxx>
#include <opencascade/TCollection_HAsciiString.hxx>
#include <opencascade/TransferBRep.hxx>
#include <opencascade/Transfer_Binder.hxx>
#include <opencascade/Transfer_TransientProcess.hxx>
#include <opencascade/XSControl_TransferReader.hxx>
#include <opencascade/XSControl_WorkSession.hxx>

#include "io_occt/cad_file.h"

namespace tessera::inline abi_0_1 {
namespace {

using opencascade::handle;

std::string name_of(const StepBasic_ProductDefinition& definition) {
  const handle<StepBasic_ProductDefinitionFormation> formation = definition.Formation();
  if (formation.IsNull() || formation->OfProduct().IsNull()) return {};
  const StepBasic_Product& product = *formation->OfProduct();
  for (const handle<TCollection_HAsciiString>& name : {product.Name(), product.Id()})
    if (!name.IsNull() && name->Length() > 0) return name->ToCString();
  return {};
}

void collect_names(const XSControl_Reader& reader, CadFile& file) {
  const handle<Transfer_TransientProcess>& process = reader.WS()->TransferReader()->TransientProcess();
  for (int k = 1; k <= process->NbMapped(); ++k) {
    const auto definition = handle<StepBasic_ProductDefinition>::DownCast(process->Mapped(k));
    const TopoDS_Shape shape = TransferBRep::ShapeResult(process->MapItem(k));
    if (!definition.IsNull() && !shape.IsNull()) file.names[identity(shape)] = name_of(*definition);
  }
}

/// Transfers all representations of shapes, for files without products: a shape that belongs to no product is not a
/// root.
void transfer_representations(STEPControl_Reader& reader) {
  const handle<Interface_InterfaceModel> model = reader.Model();
  for (int k = 1; k <= model->NbEntities(); ++k)
    if (model->Value(k)->IsKind(STANDARD_TYPE(StepShape_ShapeRepresentation))) reader.TransferEntity(model->Value(k));
}

}  // namespace

Result<CadFile> load_step(const std::string& path) {
  std::string failure;
  take_messages(failure);
  STEPControl_Reader reader;
  set_unit();
  if (reader.ReadFile(path.c_str()) != IFSelect_RetDone) {
    return Status(StatusCode::parse_error,
                  path + ": OpenCASCADE cannot read it as STEP" + (failure.empty() ? "" : ": " + failure));
  }
  reader.TransferRoots();
  if (reader.NbShapes() == 0) transfer_representations(reader);
  CadFile file = transferred(reader);
  collect_names(reader, file);
  return file;
}

}  // namespace tessera::inline abi_0_1
