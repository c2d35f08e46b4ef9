// STEP through OpenCASCADE.

#include <opencascade/STEPControl_Reader.hxx>
#include <opencascade/StepBasic_Product.hxx>
#include <opencascade/StepBasic_ProductDefinition.hxx>
#include <opencascade/StepBasic_ProductDefinitionFormation.hxx>
#include <opencascade/StepRepr_NextAssemblyUsageOccurrence.hxx>
#include <opencascade/StepShape_ShapeRepresentation.hxx>
#include <opencascade/TColStd_SequenceOfAsciiString.hxx>
#include <opencascade/TCollection_HAsciiString.hxx>
#include <opencascade/TransferBRep.hxx>
#include <opencascade/Transfer_Binder.hxx>
#include <opencascade/Transfer_TransientProcess.hxx>
#include <opencascade/XSControl_TransferReader.hxx>
#include <opencascade/XSControl_WorkSession.hxx>

#include "io_occt/cad_file.h"
#include "io_occt/memory_file.h"
#include "io_occt/step_contents.h"
#include "io_occt/step_instances.h"
#include "io_occt/text_encoding.h"
#include "tessera/io.h"

namespace tessera { inline namespace abi_0_1 {
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
    const TopoDS_Shape shape = TransferBRep::ShapeResult(process->MapItem(k));
    if (shape.IsNull()) continue;
    if (const auto product = handle<StepBasic_ProductDefinition>::DownCast(process->Mapped(k))) {
      file.names[identity(shape)] = name_of(*product);
      file.products.insert(identity(shape));
    }
    const auto use = handle<StepRepr_NextAssemblyUsageOccurrence>::DownCast(process->Mapped(k));
    if (use.IsNull()) continue;
    for (const handle<TCollection_HAsciiString>& name : {use->Id(), use->Name()})
      if (!name.IsNull() && name->UsefullLength() > 0) file.instance_names.Bind(shape, name->ToCString());
  }
}

std::string length_unit(STEPControl_Reader& reader) {
  TColStd_SequenceOfAsciiString lengths, angles, solid_angles;
  reader.FileUnits(lengths, angles, solid_angles);
  return lengths.IsEmpty() ? std::string() : lengths.First().ToCString();
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
  Result<std::string> text = read_file(path);
  if (!text) return text.status();
  const TextEncoding encoding = encoding_of(*text);
  const StepKinds kinds = step_kinds(*text);
  MemoryFile recoded;
  if (encoding != TextEncoding::utf8) {
    Result<MemoryFile> copy = MemoryFile::make(to_utf8(*text, encoding), path);
    if (!copy) return copy.status();
    recoded = *std::move(copy);
  }
  std::string().swap(*text);  // OpenCASCADE needs the memory
  std::string failure;
  take_messages(failure);
  STEPControl_Reader reader;
  set_unit();
  if (reader.ReadFile((recoded.path().empty() ? path : recoded.path()).c_str()) != IFSelect_RetDone) {
    return Status(StatusCode::parse_error,
                  path + ": OpenCASCADE cannot read it as STEP" + (failure.empty() ? "" : ": " + failure));
  }
  reader.TransferRoots();
  if (reader.NbShapes() == 0) transfer_representations(reader);
  CadFile file = transferred(reader);
  collect_names(reader, file);
  collect_colours(reader, file);
  collect_moves(reader, file);
  file.file_unit = length_unit(reader);
  file.contents = contents_of(kinds);
  if (encoding != TextEncoding::utf8)
    file.notes.push_back(std::string("its names are not UTF-8, and are taken as ") + name_of(encoding));
  if (const std::string unread = unread_shapes(kinds); !unread.empty())
    file.notes.push_back("shapes of these kinds are not read: " + unread);
  return file;
}

}}  // namespace tessera::abi_0_1
