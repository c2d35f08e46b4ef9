#include "io_occt/cad_shapes.h"

#include <opencascade/BRepTools.hxx>
#include <opencascade/BinTools.hxx>
#include <opencascade/IGESControl_Writer.hxx>
#include <opencascade/STEPControl_Writer.hxx>
#include <opencascade/TopExp_Explorer.hxx>
#include <opencascade/TopoDS.hxx>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include "support/real_files.h"
#include "tessera/cad.h"

namespace tessera::test {
namespace {

bool is_step(const std::filesystem::path& path) { return path.extension().string().starts_with(".st"); }
bool is_brep(const std::filesystem::path& path) { return path.extension().string().starts_with(".br"); }

}  // namespace

void write_cad(const TopoDS_Shape& shape, const std::string& path) {
  std::string ignored;
  take_messages(ignored);
  bool written = false;
  if (path.ends_with(".binary.brep")) {
    written = BinTools::Write(shape, path.c_str());
  } else if (is_brep(path)) {
    written = BRepTools::Write(shape, path.c_str());
  } else if (is_step(path)) {
    STEPControl_Writer writer;
    take_messages(ignored);
    written =
        writer.Transfer(shape, STEPControl_AsIs) == IFSelect_RetDone && writer.Write(path.c_str()) == IFSelect_RetDone;
  } else {
    const int faces = 0, solids = 1;
    IGESControl_Writer writer("MM", path.ends_with(".solid.igs") ? solids : faces);
    written = writer.AddShape(shape) && writer.Write(path.c_str());
  }
  if (!written) throw std::runtime_error("OpenCASCADE cannot write " + path);
}

Result<Model> read_by_opencascade(const std::filesystem::path& path, CadOptions options) {
  options.step_reader = StepReader::opencascade;
  return read_cad(path, options);
}

Result<DescribedShape> load_cad(const std::string& path) {
  return is_step(path) ? load_step(path) : is_brep(path) ? load_brep(path) : load_iges(path);
}

std::vector<TopoDS_Face> faces_of(const TopoDS_Shape& shape) {
  std::vector<TopoDS_Face> faces;
  if (shape.IsNull()) return faces;
  for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next())
    faces.push_back(TopoDS::Face(face.Current()));
  return faces;
}

std::vector<std::filesystem::path> real_cad_files() {
  std::vector<std::filesystem::path> files;
  const char* const data = std::getenv("TESSERA_TEST_DATA");
  if (!data) return files;
  for (const std::filesystem::path& file : files_below(data))
    if (is_cad_file(file)) files.push_back(file);
  return files;
}

}  // namespace tessera::test
