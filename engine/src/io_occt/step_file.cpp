// STEP through OpenCASCADE.

#include <opencascade/Quantity_Color.hxx>
#include <opencascade/STEPConstruct.hxx>
#include <opencascade/STEPConstruct_Styles.hxx>
#include <opencascade/STEPControl_Reader.hxx>
#include <opencascade/StepBasic_Product.hxx>
#include <opencascade/StepBasic_ProductDefinition.hxx>
#include <opencascade/StepBasic_ProductDefinitionFormation.hxx>
#include <opencascade/StepRepr_NextAssemblyUsageOccurrence.hxx>
#include <opencascade/StepRepr_RepresentationItem.hxx>
#include <opencascade/StepShape_ShapeRepresentation.hxx>
#include <opencascade/StepVisual_Colour.hxx>
#include <opencascade/StepVisual_PresentationStyleAssignment.hxx>
#include <opencascade/StepVisual_PresentationStyleByContext.hxx>
#include <opencascade/StepVisual_StyledItem.hxx>
#include <opencascade/TColStd_SequenceOfAsciiString.hxx>
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
    const TopoDS_Shape shape = TransferBRep::ShapeResult(process->MapItem(k));
    if (shape.IsNull()) continue;
    if (const auto product = handle<StepBasic_ProductDefinition>::DownCast(process->Mapped(k))) {
      file.names[identity(shape)] = name_of(*product);
      file.products.insert(identity(shape));
    }
    const auto use = handle<StepRepr_NextAssemblyUsageOccurrence>::DownCast(process->Mapped(k));
    if (!use.IsNull() && !use->Name().IsNull() && use->Name()->Length() > 0)
      file.instance_names.Bind(shape, use->Name()->ToCString());
  }
}

/// Whether a style is for an item in one context, such as one instance, and not wherever the item stands.
bool is_of_context(const StepVisual_StyledItem& style) {
  for (int k = 1; k <= style.NbStyles(); ++k)
    if (style.StylesValue(k)->IsKind(STANDARD_TYPE(StepVisual_PresentationStyleByContext))) return true;
  return false;
}

/// The colours of solids, shells and faces. Colours of single instances, and of edges, are left out.
void collect_colours(const XSControl_Reader& reader, CadFile& file) {
  const handle<Transfer_TransientProcess>& process = reader.WS()->TransferReader()->TransientProcess();
  STEPConstruct_Styles styles(reader.WS());
  if (!styles.LoadStyles()) return;
  for (int k = 1; k <= styles.NbStyles(); ++k) {
    const handle<StepVisual_StyledItem> style = styles.Style(k);
    handle<StepVisual_Colour> surface, border, curve, rendered;
    double transparency = 0;
    bool ignored = false;  // true also for styles without a context, in OpenCASCADE 7.6
    if (style.IsNull() || is_of_context(*style) ||
        !styles.GetColors(style, surface, border, curve, rendered, transparency, ignored))
      continue;
    Quantity_Color colour;
    const handle<StepVisual_Colour>& shown = rendered.IsNull() ? surface : rendered;
    if (shown.IsNull() || style->Item().IsNull() || !STEPConstruct_Styles::DecodeColor(shown, colour)) continue;
    const TopoDS_Shape shape = STEPConstruct::FindShape(process, style->Item());
    if (!shape.IsNull()) file.colours[identity(shape)] = colour_of(colour, 1 - transparency);
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
  collect_colours(reader, file);
  file.file_unit = length_unit(reader);
  return file;
}

}  // namespace tessera::inline abi_0_1
