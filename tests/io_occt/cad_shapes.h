#pragma once
// Shapes of OpenCASCADE's, as files and as their faces.

#include <filesystem>
#include <opencascade/TopoDS_Face.hxx>
#include <opencascade/TopoDS_Shape.hxx>
#include <string>
#include <vector>

#include "io_occt/cad_file.h"
#include "tessera/cad.h"

namespace tessera::test {

/// Writes `shape` to a STEP, an IGES or a BREP file, by the extension; .binary.brep is BREP in its binary form, and
/// .solid.igs IGES with topology: solids (186) of faces with shared edges, instead of trimmed surfaces (144).
void write_cad(const TopoDS_Shape& shape, const std::string& path);
/// The model of a file that the program tessera-cad-reader reads, whoever reads STEP by default.
Result<Model> read_by_opencascade(const std::filesystem::path& path, CadOptions options = {});
/// The file as OpenCASCADE reads it, in this process.
Result<DescribedShape> load_cad(const std::string& path);
/// In the order of models.
std::vector<TopoDS_Face> faces_of(const TopoDS_Shape& shape);

/// The files of TESSERA_TEST_DATA with extensions of CAD files, sorted; empty if the variable is not set.
std::vector<std::filesystem::path> real_cad_files();

}  // namespace tessera::test
