// Texts and files.

#include <sys/stat.h>

#include <filesystem>

#include "io/mesh/mesh_formats.h"
#include "robustness/bad_assemblies.h"
#include "robustness/bad_input.h"
#include "robustness/bad_step.h"
#include "support/random_patches.h"
#include "support/scratch_folder.h"
#include "support/synthetic_sets.h"
#include "tessera/cad.h"
#include "tessera/io.h"
#include "tessera/nurbs_surface.h"

namespace tessera::test {
namespace {

using enum StatusCode;

template <auto parser>
Status parse_faces(std::string_view text) {
  return parser(text, "m", {.keep_quads = true}).status();
}

template <auto parser>
Status parse(std::string_view text) {
  const auto result = parser(text, "m");
  return result.ok() ? Status() : result.status();
}

/// The rows of one reader: in its messages each text is called "m".
class Texts {
 public:
  /// `nothing`: the code for a text without anything that the reader reads.
  Texts(Table& table, Status (*parse)(std::string_view), const std::string& call, StatusCode nothing = parse_error)
      : table_(table), parse_(parse) {
    table_.of(call);
    row("an empty text", "", nothing);
    row("blanks", " \n\t\n", nothing);
    row("1,000 bytes of 0", std::string(1000, '\0'), parse_error);
    row("a byte order mark alone", "\xEF\xBB\xBF", nothing);
    row("words of another language", "nonsense\n", nothing);
  }
  void row(const std::string& input, const std::string& text, StatusCode code) {
    table_.row(input, code, parse_(text));
  }

 private:
  Table& table_;
  Status (*parse_)(std::string_view);
};

void bezier_texts(Table& table) {
  const std::string corners = "0 0 0\n0 1 0\n1 0 0\n1 1 0\n";
  Texts bpt(table, parse<parse_bpt>, "parse_bpt(text, name), read_model(\"m.bpt\")");
  bpt.row("4,000,000,000 patches in 20 bytes", "4000000000\n3 3\n0 0 0\n", parse_error);
  bpt.row("degree 0", "1\n0 1\n0 0 0\n0 1 0\n", parse_error);
  bpt.row("degree 16", "1\n16 1\n0 0 0\n", parse_error);
  bpt.row("nan", "1\n1 1\n0 0 0\n0 1 nan\n1 0 0\n1 1 0\n", parse_error);
  bpt.row("1e400", "1\n1 1\n0 0 0\n0 1 1e400\n1 0 0\n1 1 0\n", parse_error);
  bpt.row("a decimal comma", "1\n1 1\n0 0 0\n0 1 0,5\n1 0 0\n1 1 0\n", parse_error);
  bpt.row("a point too few", "1\n1 1\n0 0 0\n0 1 0\n1 0 0\n", parse_error);
  bpt.row("a point too many", "1\n1 1\n" + corners + "1 2 3\n", parse_error);
  Texts bv(table, parse<parse_bv>, "parse_bv(text, name)");
  bv.row("degree 99", "4\n99\n", parse_error);
  bv.row("an unknown kind", "77\n3\n", parse_error);
  bv.row("a weight of 0", "8\n1 1\n0 0 0 1\n0 1 0 1\n1 0 0 0\n1 1 0 1\n", parse_error);
  bv.row("a point too few", "4\n1\n0 0 0\n0 1 0\n", parse_error);
  Texts g2(table, parse<parse_g2>, "parse_g2(text, name)");
  g2.row("an unknown class", "999 1 0 0\n", unsupported);
  g2.row("a knot that decreases", "200 1 0 0\n3 0\n2 2\n0 0 1 1\n2 2\n0 1 0 1\n" + corners, parse_error);
  g2.row("2^31 control points", "200 1 0 0\n3 0\n2147483647 2\n0 0 1 1\n", parse_error);
}

void scene_texts(Table& table) {
  Texts obj(table, parse<parse_obj_freeform>, "parse_obj_freeform(text, name)", unsupported);
  const std::string bezier = "v 0 0 0\nv 0 1 0\nv 1 0 0\nv 1 1 0\ncstype bezier\ndeg 1 1\n";
  obj.row("an unknown index", bezier + "surf 0 1 0 1 1 2 3 9\nparm u 0 1\nparm v 0 1\nend\n", parse_error);
  obj.row("index 0", bezier + "surf 0 1 0 1 0 2 3 4\nparm u 0 1\nparm v 0 1\nend\n", parse_error);
  obj.row("no parameters", bezier + "surf 0 1 0 1 1 2 3 4\nend\n", parse_error);
  obj.row("a surface without an end", bezier + "surf 0 1 0 1 1 2 3 4\nparm u 0 1\n", parse_error);
  obj.row("a step of 0",
          "v 0 0 0\ncstype bmatrix\ndeg 1 1\nbmat u 1 0 -1 1\nbmat v 1 0 -1 1\nstep 0 0\nsurf 0 1 0 1 1 1 1 1\nparm u "
          "0 1\nparm v 0 1\nend\n",
          invalid_argument);
  Texts rib(table, parse<parse_rib>, "parse_rib(text, name)");
  rib.row("an array without an end", "Patch \"bilinear\" \"P\" [0 0 0 0 1 0", parse_error);
  rib.row("a point too few", "Patch \"bilinear\" \"P\" [0 0 0 0 1 0 1 0 0]\n", parse_error);
  rib.row("an order of 99", "NuPatch 2 99 [0 0 1 1] 0 1 2 2 [0 0 1 1] 0 1 \"P\" [0 0 0 0 1 0 1 0 0 1 1 0]\n",
          parse_error);
  rib.row("a sphere of radius 0", "Sphere 0 -1 1 360\n", parse_error);
  rib.row("an angle beyond a full turn", "Disk 0 1 400\n", parse_error);
  rib.row("an archive in a folder above", "ReadArchive \"../a.rib\"\n", unsupported);
  rib.row("an archive that is not there", "ReadArchive \"missing.rib\"\n", unsupported);
  Texts json(table, parse<parse_json_model>, "parse_json_model(text, name)");
  const auto surface = [](const std::string& members) {
    return "{\"format\": \"tessera\", \"version\": 1, \"surfaces\": [\n{" + members + "}]}";
  };
  json.row("a text that is cut", "{\"surfaces\": [", parse_error);
  json.row("another format", "{\"format\": \"gltf\", \"surfaces\": []}", parse_error);
  json.row("no surfaces", "{\"format\": \"tessera\", \"version\": 1, \"surfaces\": []}", parse_error);
  json.row("an unknown kind", surface("\"kind\": \"sponge\""), parse_error);
  json.row("a member too many", surface("\"kind\": \"bezier\", \"colour\": 3"), parse_error);
  json.row("NaN", surface("\"kind\": \"bezier\", \"degree\": [1, 1], \"points\": [NaN]"), parse_error);
  json.row("1e400", surface("\"kind\": \"bezier\", \"degree\": [1, 1], \"points\": [[1e400, 0, 0]]"), parse_error);
  const auto trimmed = [&](const std::string& loops) {
    return surface("\"kind\": \"bezier\", \"points\": [[[0,0,0],[0,1,0]],[[1,0,0],[1,1,0]]], \"trims\": " + loops);
  };
  json.row("trims that are no list", trimmed("{}"), parse_error);
  json.row("a loop without curves", trimmed("[{\"curves\": []}]"), parse_error);
  json.row("a point of a loop in space",
           trimmed("[{\"curves\": [{\"kind\": \"bezier\", \"points\": [[0,0,0],[1,0,0]]}]}]"), parse_error);
  json.row("a function as a curve of a loop", trimmed("[{\"curves\": [{\"kind\": \"parametric\", \"x\": \"t\"}]}]"),
           parse_error);
  json.row("a circle of radius 0",
           trimmed("[{\"curves\": [{\"kind\": \"circle\", \"center\": [0,0], \"radius\": 0}]}]"), invalid_argument);
  json.row("10,000 brackets", std::string(10000, '['), parse_error);
}

void step_texts(Table& table) {
  Texts step(table, parse_step, "read_cad(\"m.stp\"), parse_cad(text, \"m.stp\")");
  step_rows([&](const std::string& input, const std::string& text, StatusCode code) { step.row(input, text, code); });
  step_answers(table);
}

void kept_models(Table& table) {
  table.of("cad_model_bytes(model), parse_cad(bytes, \"m.igs\")");
  Model model;
  model.surfaces.push_back({"ball", *make_nurbs_sphere({}, 1)});
  const std::string kept = *cad_model_bytes(model);
  table.row("half of the bytes", parse_error, parse_cad(std::string_view(kept).substr(0, kept.size() / 2), "m.igs"));
  std::string damaged = kept;
  damaged.back() = '\x7f';
  table.row("a last byte that is damaged", parse_error, parse_cad(damaged, "m.igs"));
  model.surfaces.push_back({"flat", *BezierPatch::polynomial(1, 1, std::vector<Vec3>(4))});
  table.row("a surface that is no spline", unsupported, cad_model_bytes(model));
}

void mesh_texts(Table& table) {
  Texts obj(table, parse_faces<parse_obj>, "read_mesh(\"m.obj\")");
  obj.row("an unknown index", "v 0 0 0\nv 1 0 0\nf 1 2 3\n", parse_error);
  obj.row("a face of two", "v 0 0 0\nv 1 0 0\nf 1 2\n", parse_error);
  Texts ply(table, parse_faces<parse_ply>, "read_mesh(\"m.ply\")");
  ply.row("4,000,000,000 vertices",
          "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\n"
          "property float y\nproperty float z\nend_header\n",
          parse_error);
  ply.row("an unknown format", "ply\nformat binary_middle_endian 1.0\nend_header\n", parse_error);
  ply.row("a header without an end", "ply\nformat ascii 1.0\nelement vertex 1\n", parse_error);
  Texts stl(table, parse_faces<parse_stl>, "read_mesh(\"m.stl\")");
  stl.row("4,000,000,000 triangles", std::string(80, ' ') + "\xff\xff\xff\xee" + std::string(50, '\0'), parse_error);
  stl.row("a facet that is cut", "solid m\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n", parse_error);
  Texts gltf(table, parse_faces<parse_gltf>, "read_mesh(\"m.gltf\"), read_mesh(\"m.glb\")");
  gltf.row("a container that is cut", std::string("glTF\2\0\0\0\xff\0\0\0", 12), parse_error);
  gltf.row("a scene without meshes", R"({"asset": {"version": "2.0"}})", parse_error);
  gltf.row("glTF 1.0", R"({"asset": {"version": "1.0"}})", unsupported);
  const auto mesh = [](const std::string& buffer) {
    return R"({"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": )"
           R"({"POSITION": 0}}]}], "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4000000000, )"
           R"("type": "VEC3"}], "bufferViews": [{"buffer": 0, "byteLength": 3}], "buffers": [{"byteLength": 3, )"
           R"("uri": ")" +
           buffer + "\"}]}";
  };
  gltf.row("4,000,000,000 vertices", mesh("data:application/octet-stream;base64,AAAA"), parse_error);
  gltf.row("a buffer in a folder above", mesh("../m.bin"), unsupported);
  gltf.row("a buffer that is not there", mesh("missing.bin"), io_error);
}

/// In a folder of its own, so that messages name files by relative paths.
class WorkingFolder {
 public:
  WorkingFolder() : before_(std::filesystem::current_path()) { std::filesystem::current_path(folder.path()); }
  WorkingFolder(const WorkingFolder&) = delete;
  WorkingFolder& operator=(const WorkingFolder&) = delete;
  ~WorkingFolder() { std::filesystem::current_path(before_); }
  ScratchFolder folder;

 private:
  std::filesystem::path before_;
};

void reading(Table& table) {
  const WorkingFolder here;
  std::filesystem::create_directory("folder.bpt");
  std::filesystem::create_symlink("loop.ply", "loop.ply");
  here.folder.file("empty.json", "");
  here.folder.file("scene.k3d", "<k3dml/>");
  here.folder.file("mesh", "solid");
  table.of("read_model(path), read_mesh(path)");
  table.row("a file that is not there", io_error, read_model("missing.bpt"));
  table.row("a directory", io_error, read_model("folder.bpt"));
  table.row("an empty path", io_error, read_model(""));
  table.row("an empty file", parse_error, read_model("empty.json"));
  table.row("a link to itself", io_error, read_mesh("loop.ply"));
  table.row("an extension that is not known", unsupported, read_model("scene.k3d"));
  table.row("no extension", unsupported, read_mesh("mesh"));
  here.folder.file("plain.obj.gz", "v 0 0 0\n");
  here.folder.file("cut.obj.gz", std::string_view("\x1f\x8b\x08\0\0\0\0\0\0\3", 10));
  here.folder.file("packed.off.gz", "\x1f\x8b");
  table.row("a file .gz that is not packed", parse_error, read_model("plain.obj.gz"));
  table.row("a packed file that is cut", parse_error, read_mesh("cut.obj.gz"));
  table.row("an extension that is not known below .gz", unsupported, read_mesh("packed.off.gz"));
  table.row("a name of 5,000 letters", io_error, [] {
    std::string name(5000, 'x');
    const Status status = read_model(name.append(".bpt")).status();
    return Status(status.code(), "x..." + status.message().substr(5000));
  }());
}

Mesh triangle() {
  Mesh mesh;
  mesh.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  mesh.indices = {0, 1, 2};
  return mesh;
}

void writing(Table& table) {
  const WorkingFolder here;
  std::filesystem::create_directory("folder.ply");
  const std::vector<std::string> before = here.folder.names();
  const auto mesh_row = [&](const std::string& input, StatusCode code, const std::string& path, auto change) {
    Mesh mesh = triangle();
    change(mesh);
    const Status status = write_mesh(mesh, path);
    table.row(input, code, status, [&] { return here.folder.names() == before; });
  };
  const auto nothing = [](Mesh&) {};
  table.of("write_mesh(mesh, path)");
  mesh_row("an extension that is not known", unsupported, "mesh.off", nothing);
  mesh_row("a folder that is not there", io_error, "none/mesh.ply", nothing);
  mesh_row("the name of a directory", io_error, "folder.ply", nothing);
  mesh_row("no vertices", invalid_argument, "m.obj", [](Mesh& m) { m = {}; });
  mesh_row("an index that is out of range", invalid_argument, "m.ply", [](Mesh& m) { m.indices[1] = 3; });
  mesh_row("two indices", count_mismatch, "m.ply", [](Mesh& m) { m.indices.pop_back(); });
  mesh_row("eight position numbers", count_mismatch, "m.stl", [](Mesh& m) { m.positions.pop_back(); });
  mesh_row("NaN in a position", non_finite, "m.glb",
           [](Mesh& m) { m.positions[4] = static_cast<float>(not_a_number); });
  mesh_row("an origin of 1e300", non_finite, "m.stl", [](Mesh& m) { m.origin.x = 1e300; });
  mesh_row("a part that is out of range", invalid_argument, "m.gltf", [](Mesh& m) { m.parts = {{"a", 0, 9}}; });

  table.of("write_assembly(assembly, path)");
  for (const std::string path : {"a.glb", "a.ply"}) {
    bad_assemblies([&](const std::string& input, StatusCode code, const MeshAssembly& assembly) {
      table.row(input + ", for " + path.substr(1), code, write_assembly(assembly, path),
                [&] { return here.folder.names() == before; });
    });
    odd_placements([&](const std::string& input, const MeshAssembly& assembly) {
      const Status status = write_assembly(assembly, path);
      const Result<Mesh> back = read_mesh(path);
      std::filesystem::remove(path);
      table.gives(input + ", for " + path.substr(1), "accepted",
                  status.ok() && back && value_of(check(*back)).non_finite_vertices == 0);
    });
  }
  table.row("an extension that is not known", unsupported, write_assembly(sound_assembly(), "a.off"));
  table.row("nothing", invalid_argument, write_assembly({}, "a.ply"), [&] { return here.folder.names() == before; });

  Random random(5);
  const BezierPatch plain = random_polynomial(random, 2, 2), rational = random_rational(random, 2, 2);
  const auto model_row = [&](const std::string& input, StatusCode code, const Model& model, const std::string& path) {
    const auto written = write_model(model, path);
    table.row(input, code, written ? Status() : written.status(), [&] { return here.folder.names() == before; });
  };
  table.of("write_model(model, path, fit)");
  model_row("no surfaces", invalid_argument, {}, "m.obj");
  model_row("an extension that is not known", unsupported, {.name = "m", .surfaces = {{"a", plain}}}, "m.step");
  model_row("a rational surface for .bpt", unsupported, {.name = "m", .surfaces = {{"a", plain}, {"b", rational}}},
            "m.bpt");
  model_row("a placement with NaN", non_finite,
            {.name = "m", .surfaces = {{"a", plain, Affine::translated({not_a_number, 0, 0})}}}, "m.obj");
  model_row("a folder that is not there", io_error, {.name = "m", .surfaces = {{"a", plain}}}, "none/m.obj");
}

}  // namespace

void fill_readers(Table& table) {
  bezier_texts(table);
  scene_texts(table);
  step_texts(table);
  kept_models(table);
  mesh_texts(table);
}

void fill_files(Table& table) {
  reading(table);
  writing(table);
}

}  // namespace tessera::test
