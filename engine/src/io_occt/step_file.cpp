// STEP through OpenCASCADE.

#include <opencascade/Geom_CartesianPoint.hxx>
#include <opencascade/Geom_Direction.hxx>
#include <opencascade/Quantity_Color.hxx>
#include <opencascade/STEPConstruct.hxx>
#include <opencascade/STEPConstruct_Styles.hxx>
#include <opencascade/STEPControl_Reader.hxx>
#include <opencascade/StepBasic_Product.hxx>
#include <opencascade/StepBasic_ProductDefinition.hxx>
#include <opencascade/StepBasic_ProductDefinitionFormation.hxx>
#include <opencascade/StepBasic_ProductDefinitionRelationship.hxx>
#include <opencascade/StepGeom_CartesianTransformationOperator3d.hxx>
#include <opencascade/StepGeom_Direction.hxx>
#include <opencascade/StepRepr_CharacterizedDefinition.hxx>
#include <opencascade/StepRepr_MappedItem.hxx>
#include <opencascade/StepRepr_NextAssemblyUsageOccurrence.hxx>
#include <opencascade/StepRepr_PropertyDefinition.hxx>
#include <opencascade/StepRepr_PropertyDefinitionRepresentation.hxx>
#include <opencascade/StepRepr_Representation.hxx>
#include <opencascade/StepRepr_RepresentationItem.hxx>
#include <opencascade/StepRepr_RepresentedDefinition.hxx>
#include <opencascade/StepShape_ShapeRepresentation.hxx>
#include <opencascade/StepToGeom.hxx>
#include <opencascade/StepVisual_Colour.hxx>
#include <opencascade/StepVisual_ContextDependentOverRidingStyledItem.hxx>
#include <opencascade/StepVisual_PresentationStyleAssignment.hxx>
#include <opencascade/StepVisual_PresentationStyleByContext.hxx>
#include <opencascade/StepVisual_StyleContextSelect.hxx>
#include <opencascade/StepVisual_StyledItem.hxx>
#include <opencascade/TColStd_SequenceOfAsciiString.hxx>
#include <opencascade/TCollection_HAsciiString.hxx>
#include <opencascade/TransferBRep.hxx>
#include <opencascade/Transfer_Binder.hxx>
#include <opencascade/Transfer_TransientProcess.hxx>
#include <opencascade/XSControl_Reader.hxx>
#include <opencascade/XSControl_TransferReader.hxx>
#include <opencascade/XSControl_WorkSession.hxx>

#include <cmath>

#include "base/text.h"
#include "io/file/memory_file.h"
#include "io/file/text_encoding.h"
#include "io/step/step_contents.h"
#include "io/step/step_index.h"
#include "io_occt/cad_file.h"
#include "occt/part_tree.h"
#include "occt/spline_line.h"
#include "tessera/io.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

// Reads what a STEP file states of single instances of parts, beyond their names and rigid places.

using opencascade::handle;
using Entity = handle<Standard_Transient>;

/// The contexts, such as one instance, to which a style is limited; empty for a style of an item wherever it stands. A
/// mapped item is an instance itself.
std::vector<Entity> contexts_of(const StepVisual_StyledItem& style) {
  std::vector<Entity> contexts;
  for (int k = 1; k <= style.NbStyles(); ++k)
    if (const auto limited = handle<StepVisual_PresentationStyleByContext>::DownCast(style.StylesValue(k)))
      contexts.push_back(limited->StyleContext().Value());
  if (const auto* const over = dynamic_cast<const StepVisual_ContextDependentOverRidingStyledItem*>(&style))
    for (int k = 1; k <= over->NbStyleContext(); ++k) contexts.push_back(over->StyleContextValue(k).Value());
  if (contexts.empty() && style.Item()->IsKind(STANDARD_TYPE(StepRepr_MappedItem))) contexts.push_back(style.Item());
  return contexts;
}

/// The use of a part in an assembly that a representation is of; null if it is of something else.
Entity use_of(const StepRepr_PropertyDefinitionRepresentation& link) {
  const handle<StepRepr_PropertyDefinition> property = link.Definition().PropertyDefinition();
  return property.IsNull() ? Entity() : Entity(property->Definition().ProductDefinitionRelationship());
}

/// Finds the instances that are contexts of styles.
class Instances {
 public:
  explicit Instances(const XSControl_Reader& reader)
      : process_(reader.WS()->TransferReader()->TransientProcess()), model_(reader.Model()) {}

  /// The part at its place in the whole that holds it; null if the context is no instance.
  TopoDS_Shape shape_of(const Entity& context) {
    if (context.IsNull()) return {};
    if (context->IsKind(STANDARD_TYPE(StepRepr_MappedItem))) return shape_made_of(context);
    if (uses_.empty()) find_uses();
    const auto use = uses_.find(context.get());
    return use == uses_.end() ? TopoDS_Shape() : shape_made_of(use->second);
  }

 private:
  TopoDS_Shape shape_made_of(const Entity& entity) const { return TransferBRep::ShapeResult(process_->Find(entity)); }

  void find_uses() {
    for (int k = 1; k <= model_->NbEntities(); ++k) {
      const auto link = handle<StepRepr_PropertyDefinitionRepresentation>::DownCast(model_->Value(k));
      if (link.IsNull() || link->UsedRepresentation().IsNull()) continue;
      if (const Entity use = use_of(*link); !use.IsNull()) uses_[link->UsedRepresentation().get()] = use;
    }
  }

  handle<Transfer_TransientProcess> process_;
  handle<Interface_InterfaceModel> model_;
  std::unordered_map<const void*, Entity> uses_;  ///< by representation
};

/// Directions of the operator's axes (ISO 10303-42, base_axis), and its scale.
Affine operator_map(const StepGeom_CartesianTransformationOperator3d& op) {
  const auto direction = [](const handle<StepGeom_Direction>& given, const Vec3& otherwise) {
    const handle<Geom_Direction> made = given.IsNull() ? handle<Geom_Direction>() : StepToGeom::MakeDirection(given);
    return made.IsNull() ? otherwise : vec3(made->Dir().XYZ());
  };
  const auto unit = [](const Vec3& v) { return (1 / length(v)) * v; };
  const Vec3 z = unit(direction(op.Axis3(), {0, 0, 1}));
  const Vec3 near_x = std::abs(z.x) > 1 - 1e-9 ? Vec3{0, 0, 1} : Vec3{1, 0, 0};
  const Vec3 given_x = direction(op.Axis1(), near_x);
  const Vec3 x = unit(given_x - dot(given_x, z) * z);
  const Vec3 third = cross(z, x);
  const Vec3 y = dot(direction(op.Axis2(), third), third) < 0 ? -1 * third : third;
  const double scale = op.HasScale() ? op.Scale() : 1;
  const handle<Geom_CartesianPoint> origin = StepToGeom::MakeCartesianPoint(op.LocalOrigin());
  return {.columns = {scale * x, scale * y, scale * z}, .translation = vec3(origin->Pnt().XYZ())};
}

bool is_identity(const Affine& map, double size) {
  double off = 0;
  for (int k = 0; k < 3; ++k)
    off =
        std::max(off, length(map.columns[static_cast<std::size_t>(k)] - Affine{}.columns[static_cast<std::size_t>(k)]));
  return off <= 1e-9 && length(map.translation) <= 1e-9 * (1 + size);
}

/// Collects the colours of solids, shells and faces, wherever they stand and at single instances. Colours of edges are
/// left out.
void collect_colours(const XSControl_Reader& reader, DescribedShape& file) {
  const handle<Transfer_TransientProcess>& process = reader.WS()->TransferReader()->TransientProcess();
  STEPConstruct_Styles styles(reader.WS());
  if (!styles.LoadStyles()) return;
  Instances instances(reader);
  std::size_t unread = 0;
  for (int k = 1; k <= styles.NbStyles(); ++k) {
    const handle<StepVisual_StyledItem> style = styles.Style(k);
    handle<StepVisual_Colour> surface, border, curve, rendered;
    double transparency = 0;
    bool ignored = false;  // true also for styles without a context, in OpenCASCADE 7.6
    if (style.IsNull() || !styles.GetColors(style, surface, border, curve, rendered, transparency, ignored)) continue;
    Quantity_Color colour;
    const handle<StepVisual_Colour>& shown = rendered.IsNull() ? surface : rendered;
    if (shown.IsNull() || style->Item().IsNull() || !STEPConstruct_Styles::DecodeColor(shown, colour)) continue;
    const TopoDS_Shape shape = STEPConstruct::FindShape(process, style->Item());
    if (shape.IsNull()) continue;
    DescribedShape::Colours* colours = &file.colours;
    if (const std::vector<Entity> contexts = contexts_of(*style); !contexts.empty()) {
      const TopoDS_Shape instance = contexts.size() == 1 ? instances.shape_of(contexts[0]) : TopoDS_Shape();
      if (instance.IsNull()) {
        ++unread;
        continue;
      }
      if (!file.instance_colours.IsBound(instance)) file.instance_colours.Bind(instance, {});
      colours = &file.instance_colours.ChangeFind(instance);
    }
    (*colours)[identity(shape)] = colour_of(colour, 1 - transparency);
  }
  if (unread > 0) file.notes.push_back(counted(unread, "colour") + " of single contexts not read");
}

/// Collects the scales and mirrors of mapped items: OpenCASCADE places these rigidly.
void collect_moves(const XSControl_Reader& reader, DescribedShape& file) {
  const handle<Transfer_TransientProcess>& process = reader.WS()->TransferReader()->TransientProcess();
  for (int k = 1; k <= process->NbMapped(); ++k) {
    const auto item = handle<StepRepr_MappedItem>::DownCast(process->Mapped(k));
    const TopoDS_Shape shape = TransferBRep::ShapeResult(process->MapItem(k));
    if (item.IsNull() || shape.IsNull()) continue;
    const auto op = handle<StepGeom_CartesianTransformationOperator3d>::DownCast(item->MappingTarget());
    gp_Trsf rigid;
    if (op.IsNull() || op->LocalOrigin().IsNull() || !StepToGeom::MakeTransformation3d(op, rigid)) continue;
    const Affine whole = operator_map(*op), move = whole * affine(rigid.Inverted());
    if (!is_identity(move, length(whole.translation))) file.moves.Bind(shape, move);
  }
}

using opencascade::handle;

std::string name_of(const StepBasic_ProductDefinition& definition) {
  const handle<StepBasic_ProductDefinitionFormation> formation = definition.Formation();
  if (formation.IsNull() || formation->OfProduct().IsNull()) return {};
  const StepBasic_Product& product = *formation->OfProduct();
  for (const handle<TCollection_HAsciiString>& name : {product.Name(), product.Id()})
    if (!name.IsNull() && name->Length() > 0) return name->ToCString();
  return {};
}

void collect_names(const XSControl_Reader& reader, DescribedShape& file) {
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

Result<DescribedShape> load_step(const std::string& path) {
  Result<std::string> text = read_file(path);
  if (!text) return text.status();
  const TextEncoding encoding = encoding_of(*text);
  std::string contents, unread;
  if (const Result<StepIndex> index = StepIndex::make(*text); index) {
    const StepKinds kinds = step_kinds(*index);
    contents = contents_of(kinds), unread = unread_shapes(kinds);
  }
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
  DescribedShape file = transferred(reader);
  collect_names(reader, file);
  collect_colours(reader, file);
  collect_moves(reader, file);
  file.file_unit = length_unit(reader);
  file.contents = contents;
  if (encoding != TextEncoding::utf8)
    file.notes.push_back(std::string("its names are not UTF-8, and are taken as ") + name_of(encoding));
  if (!unread.empty()) file.notes.push_back("shapes of these kinds are not read: " + unread);
  return file;
}

}}  // namespace tessera::abi_0_1
