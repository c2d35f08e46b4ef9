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
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "base/text.h"
#include "io/file/memory_file.h"
#include "io/file/text_encoding.h"
#include "io_occt/cad_file.h"
#include "io_occt/iges_surfaces.h"
#include "tessera/io.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

// The frame of an IGES file: lines of 80 characters; the 73rd is the letter of their section.

/// The letter of a line's section; 0 for a line that is too short.
char section_of(const std::string& line) {
  constexpr std::size_t column = 72;
  return line.size() > column ? line[column] : '\0';
}

/// Checks that the file begins with section S and has section T, its last: OpenCASCADE takes a truncated file for a
/// whole one. Errors: parse_error, io_error, unsupported (the compressed and the binary form).
Status check_iges_sections(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string line;
  std::size_t number = 0;
  bool ended = false;
  while (!ended && std::getline(file, line)) {
    const char section = section_of(line);
    if (++number == 1 && (section == 'C' || section == 'B'))
      return Status(StatusCode::unsupported,
                    path + ": IGES in its " + (section == 'C' ? "compressed" : "binary") + " form is not read");
    if (number == 1 && section != 'S')
      return Status(StatusCode::parse_error, path + ":1: this is not IGES: the first line has no S in column 73");
    ended = section == 'T';
  }
  if (file.bad()) return Status(StatusCode::io_error, path + ": cannot be read");
  if (!ended)
    return Status(StatusCode::parse_error,
                  path + ":" + std::to_string(number) + ": the file ends before its section T: it is truncated");
  return {};
}

// Checks and completes the B-spline surfaces in the text of an IGES file.

Status check_weights(const IgesSurface& surface, const std::string& path) {
  if (surface.number(7) == 1) return {};  // a polynomial surface
  const std::size_t first = surface.weights(), row = surface.row();
  for (std::size_t k = 0; k < row * surface.rows() && first + k < surface.words.size(); ++k) {
    const double weight = surface.number(first + k);
    if (weight > 0) continue;
    return Status(StatusCode::invalid_weight, path + ": surface " + surface.entity + ": weight [" +
                                                  std::to_string(k % row) + "][" + std::to_string(k / row) + "] is " +
                                                  text(weight) + ", it must be greater than 0");
  }
  return {};
}

/// Completes the ranges of a surface. Whether any end was missing.
bool complete(IgesSurface& surface) {
  const std::size_t first = surface.ranges();
  if (surface.words.size() < first) return false;  // points are missing, too
  // Parameters run from knot M to knot K + 1, counted from 0.
  const std::array<std::size_t, 4> ends{surface.knots_u() + surface.count(3), surface.knots_u() + surface.row(),
                                        surface.knots_v() + surface.count(4), surface.knots_v() + surface.rows()};
  bool missing = false;
  for (std::size_t k = 0; k < ends.size(); ++k) {
    if (first + k == surface.words.size()) surface.words.emplace_back();
    std::string& word = surface.words[first + k];
    if (!word.empty()) continue;
    word = surface.words[ends[k]];
    missing = true;
  }
  return missing;
}

/// Appends the record of a surface. OpenCASCADE finds the lines of an entity by the number at their end.
void append_record(const IgesSurface& surface, std::string& out) {
  constexpr std::size_t columns = 64;
  std::string line;
  const auto end_line = [&] {
    line.resize(columns, ' ');
    out += line;
    out += surface.begin_of_tail;
    line.clear();
  };
  for (std::size_t k = 0; k < surface.words.size(); ++k) {
    const std::string word = surface.words[k] + (k + 1 < surface.words.size() ? surface.parameter : surface.terminator);
    if (line.size() + word.size() > columns) end_line();
    line += word;
  }
  end_line();
}

/// Checks that the weights of all entities of type 128 are positive. If one is not, OpenCASCADE silently drops all
/// weights of that surface and reads another one. Text that is not a number is left to OpenCASCADE. Messages begin with
/// `path`. Errors: invalid_weight (names the entity and the weight).
Status check_iges_weights(std::string_view text, const std::string& path) {
  for (const IgesSurface& surface : iges_surfaces(text))
    if (Status status = check_weights(surface, path); !status.ok()) return status;
  return {};
}

/// The text with the ranges of parameters that entities of type 128 leave out: those of their knots. OpenCASCADE drops
/// a surface without its ranges. Empty if none is left out.
std::optional<std::string> with_iges_ranges(std::string_view text) {
  std::string out;
  std::size_t done = 0;
  for (IgesSurface& surface : iges_surfaces(text)) {
    if (!complete(surface)) continue;
    out += text.substr(done, surface.begin - done);
    append_record(surface, out);
    done = surface.end;
  }
  if (done == 0) return {};
  out += text.substr(done);
  return out;
}

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

void collect_names(const XSControl_Reader& reader, TextEncoding encoding, DescribedShape& file) {
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
void collect_ranges(const XSControl_Reader& reader, std::string_view text, DescribedShape& file) {
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

Result<DescribedShape> load_iges(const std::string& path) {
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
  DescribedShape file = transferred(reader);
  collect_names(reader, encoding_of(*text), file);
  collect_ranges(reader, *text, file);
  file.contents = types_of(*reader.Model());
  file.file_unit = length_unit(*reader.Model());
  return file;
}

}}  // namespace tessera::abi_0_1
