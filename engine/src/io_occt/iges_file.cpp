// IGES through OpenCASCADE.

#include <opencascade/IGESControl_Reader.hxx>
#include <opencascade/IGESData_GlobalSection.hxx>
#include <opencascade/IGESData_IGESEntity.hxx>
#include <opencascade/IGESData_IGESModel.hxx>
#include <opencascade/IGESGeom_BSplineSurface.hxx>
#include <opencascade/IGESGeom_TrimmedSurface.hxx>
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
#include <string_view>

#include "io_occt/cad_file.h"
#include "io_occt/iges_sections.h"
#include "io_occt/iges_surfaces.h"
#include "io_occt/iges_text.h"
#include "io_occt/memory_file.h"
#include "io_occt/text_encoding.h"
#include "tessera/io.h"

namespace tessera { inline namespace abi_0_1 {
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

void collect_names(const XSControl_Reader& reader, TextEncoding encoding, CadFile& file) {
  bool recoded = false;
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
    if (name->Length() == 0) continue;
    const std::string given = name->ToCString();
    std::string& known = file.names[identity(shape)];
    known = to_utf8(given, encoding);
    recoded = recoded || known != given;
  }
  if (recoded) file.notes.push_back(std::string("its names are not UTF-8, and are taken as ") + name_of(encoding));
}

/// The B-spline surface that a face is the whole of; null if loops bound the face.
handle<Standard_Transient> whole_surface(const handle<Standard_Transient>& entity) {
  const auto trimmed = handle<IGESGeom_TrimmedSurface>::DownCast(entity);
  if (trimmed.IsNull()) return handle<IGESGeom_BSplineSurface>::DownCast(entity);
  if (trimmed->HasOuterContour() || trimmed->NbInnerContours() > 0) return {};
  return handle<IGESGeom_BSplineSurface>::DownCast(trimmed->Surface());
}

/// The ranges that surfaces state, from the file's text: OpenCASCADE ignores them, and its version 7.6 mixes up those
/// of u and v.
void collect_ranges(const XSControl_Reader& reader, std::string_view text, CadFile& file) {
  std::map<std::string, Domain> stated;
  for (const IgesSurface& surface : iges_surfaces(text)) {
    const std::size_t k = surface.ranges();
    if (surface.words.size() >= k + 4)
      stated[surface.entity] = {surface.number(k), surface.number(k + 1), surface.number(k + 2), surface.number(k + 3)};
  }
  const handle<Interface_InterfaceModel> model = reader.Model();
  const handle<Transfer_TransientProcess>& process = reader.WS()->TransferReader()->TransientProcess();
  for (int k = 1; k <= process->NbMapped(); ++k) {
    const handle<Standard_Transient> surface = whole_surface(process->Mapped(k));
    const TopoDS_Shape shape = TransferBRep::ShapeResult(process->MapItem(k));
    if (surface.IsNull() || shape.IsNull() || shape.ShapeType() != TopAbs_FACE) continue;
    const auto range = stated.find(label_of(*model, surface));
    if (range != stated.end()) file.ranges[identity(shape)] = range->second;
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
  const Result<std::string> text = read_file(path);
  if (!text) return text.status();
  if (Status status = check_iges_weights(*text, path); !status.ok()) return status;
  MemoryFile completed;
  if (const std::optional<std::string> whole = with_iges_ranges(*text)) {
    Result<MemoryFile> copy = MemoryFile::make(*whole, path);
    if (!copy) return copy.status();
    completed = *std::move(copy);
  }
  std::string failure;
  take_messages(failure);
  IGESControl_Reader reader;
  set_unit();
  // Keeps splines whole, rather than splitting them where they are only C0.
  Interface_Static::SetIVal("read.iges.bspline.continuity", 0);
  reader.SetReadVisible(false);
  if (reader.ReadFile((completed.path().empty() ? path : completed.path()).c_str()) != IFSelect_RetDone) {
    return Status(StatusCode::parse_error,
                  path + ": OpenCASCADE cannot read it as IGES" + (failure.empty() ? "" : ": " + failure));
  }
  reader.TransferRoots();
  CadFile file = transferred(reader);
  collect_names(reader, encoding_of(*text), file);
  collect_ranges(reader, *text, file);
  file.contents = types_of(*reader.Model());
  file.file_unit = length_unit(*reader.Model());
  return file;
}

}}  // namespace tessera::abi_0_1
