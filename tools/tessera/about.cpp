#include "commands/commands.h"
#include "stages/load.h"
#include "tessera/cad.h"
#include "tessera/version.h"

namespace tessera::cli {
namespace {

constexpr const char* mesh_formats = ".obj, .ply, .stl, .glb, .gltf";

std::string cad_reader_text() {
  const Result<std::filesystem::path> reader = find_cad_reader();
  if (!reader) return "not found: " + reader.status().message();
  std::error_code error;
  return reader->string() + (std::filesystem::exists(*reader, error) ? "" : ", which does not exist");
}

}  // namespace

std::string version_text() {
#ifdef TESSERA_HAS_ZLIB
  constexpr const char* packed = "read (.obj.gz, .stpz)";
#else
  constexpr const char* packed = "not read: built without zlib";
#endif
  const std::string meshes = mesh_formats;
  return "tessera " TESSERA_VERSION "\nReads surfaces: " + model_formats() + "\nReads meshes: " + meshes +
         "\nWrites surfaces: .obj, .json, .bpt\nWrites meshes: " + meshes +
         "; in pieces .ply, .pvtp\nWrites pictures: .png, .exr\nCAD reader (IGES, BREP, STEP on request): " +
         cad_reader_text() + "\nPacked files: " + packed + "\n";
}

void describe(Command& tool) {
  tool.name = "tessera";
  tool.text = "Tessera turns parametric surfaces into points, meshes, pictures and ray hits";
  tool.footer =
      "Files read: surfaces as " + model_formats() +
      ";\n"
      "meshes as " +
      mesh_formats +
      ". Surfaces are Bezier patches (.bpt), BezierView (.bv), GoTools (.g2),\n"
      "RenderMan (.rib), free-form OBJ, CAD parts (IGES and BREP by tessera-cad-reader), and surfaces of every kind\n"
      "(.json; share/doc/tessera/FORMAT.md describes the format). A warning names each part of a file that is "
      "skipped.\n"
      "Files may be packed by gzip (.obj.gz), CAD parts also by zip (.stpz).\n"
      "\nFiles written: meshes as .obj, .ply, .stl, .glb and .gltf; surfaces as .obj, .json and .bpt; pictures as "
      ".png, and "
      "as\n"
      ".exr (numbers: depth, normals, parameters); tables as text. A file appears whole or not at all.\n"
      "\nSeveral files: a command takes names and quoted patterns ('parts/*.bpt'). A pattern means the files that "
      "match\n"
      "it, sorted. With one output, all files are one scene. If the output is a folder, or contains {name} (the "
      "file's\n"
      "name without folder and extension), each file gets its own result. If a file fails, the others go on.\n"
      "Surfaces, patches and rays are counted from 0. Surfaces are counted on from file to file.\n"
      "\nReports: --json prints objects, whose keys share/doc/tessera/JSON.md lists.\n"
      "\nEnvironment: TESSERA_ISA=sse2|avx2|avx512 does the same as --isa, TESSERA_CAD_READER=FILE as --cad-reader,\n"
      "TESSERA_WEB=FOLDER as --web; NO_COLOR turns colours off.\n"
      "\nAfter -- no options follow: tessera info -- -part.json.\n"
      "\nExit status: 0 done, 1 an input is bad, an output cannot be written, tessellate --strict finds a fault or\n"
      "compare a deviation beyond --tolerance, 2 the command line is bad.\n"
      "\nExamples:\n"
      "  tessera info 'models/*.json'\n"
      "  tessera raycast teapot.bpt\n"
      "  tessera raycast teapot.bpt -o teapot.png --size 1280x720\n"
      "  tessera tessellate body.iges wing.iges -o plane.ply --grid 8x8\n"
      "  tessera convert goblet.json -o goblet.obj\n"
      "  tessera raycast 'parts/*.step' -o 'pictures/{name}.png' --json\n"
      "  eval \"$(tessera completion bash)\"";
}

}  // namespace tessera::cli
