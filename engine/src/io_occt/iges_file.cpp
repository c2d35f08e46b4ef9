// IGES through OpenCASCADE.

#include <opencascade/IGESControl_Reader.hxx>
#include <opencascade/IGESData_IGESEntity.hxx>
#include <opencascade/Interface_InterfaceModel.hxx>
#include <opencascade/Interface_Static.hxx>
#include <opencascade/TCollection_HAsciiString.hxx>
#include <opencascade/TransferBRep.hxx>
#include <opencascade/Transfer_Binder.hxx>
#include <opencascade/Transfer_TransientProcess.hxx>
#include <opencascade/XSControl_TransferReader.hxx>
#include <opencascade/XSControl_WorkSession.hxx>

#include <map>

#include "io_occt/cad_file.h"
#include "io_occt/iges_sections.h"
#include "io_occt/iges_weights.h"

namespace tessera::inline abi_0_1 {
namespace {

using opencascade::handle;

void collect_names(const XSControl_Reader& reader, CadFile& file) {
  const handle<Transfer_TransientProcess>& process = reader.WS()->TransferReader()->TransientProcess();
  for (int k = 1; k <= process->NbMapped(); ++k) {
    const auto entity = handle<IGESData_IGESEntity>::DownCast(process->Mapped(k));
    const TopoDS_Shape shape = TransferBRep::ShapeResult(process->MapItem(k));
    if (entity.IsNull() || shape.IsNull()) continue;
    const handle<TCollection_HAsciiString> name = entity->NameValue();
    if (name.IsNull()) continue;
    name->LeftAdjust();
    name->RightAdjust();
    if (name->Length() > 0) file.names[identity(shape)] = name->ToCString();
  }
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
  return file;
}

}  // namespace tessera::inline abi_0_1
