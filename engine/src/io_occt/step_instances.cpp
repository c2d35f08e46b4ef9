#include "io_occt/step_instances.h"

#include <opencascade/Geom_CartesianPoint.hxx>
#include <opencascade/Geom_Direction.hxx>
#include <opencascade/Quantity_Color.hxx>
#include <opencascade/STEPConstruct.hxx>
#include <opencascade/STEPConstruct_Styles.hxx>
#include <opencascade/StepBasic_ProductDefinitionRelationship.hxx>
#include <opencascade/StepGeom_CartesianTransformationOperator3d.hxx>
#include <opencascade/StepGeom_Direction.hxx>
#include <opencascade/StepRepr_CharacterizedDefinition.hxx>
#include <opencascade/StepRepr_MappedItem.hxx>
#include <opencascade/StepRepr_PropertyDefinition.hxx>
#include <opencascade/StepRepr_PropertyDefinitionRepresentation.hxx>
#include <opencascade/StepRepr_Representation.hxx>
#include <opencascade/StepRepr_RepresentationItem.hxx>
#include <opencascade/StepRepr_RepresentedDefinition.hxx>
#include <opencascade/StepToGeom.hxx>
#include <opencascade/StepVisual_Colour.hxx>
#include <opencascade/StepVisual_ContextDependentOverRidingStyledItem.hxx>
#include <opencascade/StepVisual_PresentationStyleAssignment.hxx>
#include <opencascade/StepVisual_PresentationStyleByContext.hxx>
#include <opencascade/StepVisual_StyleContextSelect.hxx>
#include <opencascade/StepVisual_StyledItem.hxx>
#include <opencascade/TransferBRep.hxx>
#include <opencascade/Transfer_Binder.hxx>
#include <opencascade/Transfer_TransientProcess.hxx>
#include <opencascade/XSControl_TransferReader.hxx>
#include <opencascade/XSControl_WorkSession.hxx>

#include <cmath>

#include "base/text.h"
#include "io_occt/part_tree.h"
#include "io_occt/spline_line.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

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

}  // namespace

void collect_colours(const XSControl_Reader& reader, CadFile& file) {
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
    CadFile::Colours* colours = &file.colours;
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

void collect_moves(const XSControl_Reader& reader, CadFile& file) {
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

}}  // namespace tessera::abi_0_1
