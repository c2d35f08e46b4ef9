// IGES through OpenCASCADE.

#include <opencascade/IGESControl_Reader.hxx>
#include <opencascade/IGESData_GlobalSection.hxx>
#include <opencascade/IGESData_IGESEntity.hxx>
#include <opencascade/IGESData_IGESModel.hxx>
#include <opencascade/IGESGraph_Color.hxx>
#include <opencascade/Interface_InterfaceModel.hxx>
#include <opencascade/Interface_Static.hxx>
#include <opencascade/TCollection_HAsciiString.hxx>
#include <opencascade/TransferBRep.hxx>
#include <opencascade/Transfer_Binder.hxx>
#include <opencascade/Transfer_TransientProcess.hxx>
#include <opencascade/XSControl_TransferReader.hxx>
#include <opencascade/XSControl_WorkSession.hxx>

#include <algorithm>
#include <array>
#include <map>
#include <optional>

#include "io_occt/cad_file.h"
#include "io_occt/iges_sections.h"
#include "io_occt/iges_weights.h"

namespace tessera::inline abi_0_1 {
namespace {

using opencascade::handle;

/// The colour of an entity: one of eight, or a definition of its own (IGES 5.3, sec. 2.2.4.4.13 and 4.77).
std::optional<Colour> colour_of(const IGESData_IGESEntity& entity) {
  constexpr std::array<Colour, 9> known{
      {{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}}};
  const int rank = entity.RankColor();
  if (rank > 0 && rank < static_cast<int>(known.size())) return known[static_cast<std::size_t>(rank)];
  const auto own = handle<IGESGraph_Color>::DownCast(entity.Color());
  if (rank >= 0 || own.IsNull()) return {};
  double red = 0, green = 0, blue = 0;
  own->RGBIntensity(red, green, blue);
  const auto part = [](double percent) {
    return percent > 0 ? static_cast<float>(std::min(percent / 100, 1.0)) : 0.0F;
  };
  return Colour{part(red), part(green), part(blue)};
}

void collect_names(const XSControl_Reader& reader, CadFile& file) {
  const handle<Transfer_TransientProcess>& process = reader.WS()->TransferReader()->TransientProcess();
  for (int k = 1; k <= process->NbMapped(); ++k) {
    const auto entity = handle<IGESData_IGESEntity>::DownCast(process->Mapped(k));
    const TopoDS_Shape shape = TransferBRep::ShapeResult(process->MapItem(k));
    if (entity.IsNull() || shape.IsNull()) continue;
    if (const std::optional<Colour> colour = colour_of(*entity)) file.colours[identity(shape)] = *colour;
    const handle<TCollection_HAsciiString> name = entity->NameValue();
    if (name.IsNull()) continue;
    name->LeftAdjust();
    name->RightAdjust();
    if (name->Length() > 0) file.names[identity(shape)] = name->ToCString();
  }
}

std::string length_unit(const Interface_InterfaceModel& model) {
  const auto* const iges = dynamic_cast<const IGESData_IGESModel*>(&model);
  const handle<TCollection_HAsciiString> unit =
      iges ? iges->GlobalSection().UnitName() : handle<TCollection_HAsciiString>();
  return unit.IsNull() ? std::string() : std::string(unit->ToCString());
}

/// "2 of type 110, 7 of type 126".
std::string types_of(const Interface_InterfaceModel& model) {
  std::map<int, int> counts;
  for (int k = 1; k <= model.NbEntities(); ++k) {
    const auto entity = handle<IGESData_IGESEntity>::DownCast(model.Value(k));
    if (!entity.IsNull()) ++counts[entity->TypeNumber()];
  }
  std::string text;
  for (const auto& [type, count] : counts)
    text += (text.empty() ? "" : ", ") + std::to_string(count) + " of type " + std::to_string(type);
  return text;
}

}  // namespace

Result<CadFile> load_iges(const std::string& path) {
  if (Status status = check_iges_sections(path); !status.ok()) return status;
  if (Status status = check_iges_weights(path); !status.ok()) return status;
  std::string failure;
  take_messages(failure);
  IGESControl_Reader reader;
  set_unit();
  // Keeps splines whole, rather than splitting them where they are only C0.
  Interface_Static::SetIVal("read.iges.bspline.continuity", 0);
  reader.SetReadVisible(false);
  if (reader.ReadFile(path.c_str()) != IFSelect_RetDone) {
    return Status(StatusCode::parse_error,
                  path + ": OpenCASCADE cannot read it as IGES" + (failure.empty() ? "" : ": " + failure));
  }
  reader.TransferRoots();
  CadFile file = transferred(reader);
  collect_names(reader, file);
  file.contents = types_of(*reader.Model());
  file.file_unit = length_unit(*reader.Model());
  return file;
}

}  // namespace tessera::inline abi_0_1
