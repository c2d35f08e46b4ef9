// Parts with instances through tessera tessellate: each shape is meshed once, and every instance keeps the tolerance.

#include <cmath>
#include <cstring>

#include "io/cad/kept_model.h"
#include "io/cad/model_bytes.h"
#include "support/synthetic_sets.h"
#include "tessera/io.h"
#include "tessera/mesh_assembly.h"
#include "tessera/topology.h"
#include "tools/tool_test.h"

namespace tessera::test { namespace {

using nlohmann::json;

/// The surface z = x^2 over [-1, 1] x [0, 1], and the square z = 2 above it.
Shape channel() {
  const std::vector<double> line{0, 0, 1, 1}, parabola{0, 0, 0, 1, 1, 1};
  const std::vector<Vec3> bent{{-1, 0, 1}, {-1, 1, 1}, {0, 0, -1}, {0, 1, -1}, {1, 0, 1}, {1, 1, 1}};
  const std::vector<Vec3> flat{{-1, 0, 2}, {-1, 1, 2}, {1, 0, 2}, {1, 1, 2}};
  Shape shape;
  shape.name = std::string("channel");
  shape.faces = {{{std::string("bent"), value_of(BSplineSurface::polynomial(2, parabola, 1, line, bent))}},
                 {{{}, value_of(BSplineSurface::polynomial(1, line, 1, line, flat))}}};
  shape.faces[0].colour = Colour{1, 0, 0};
  return shape;
}

/// A program that reads CAD files stands for OpenCASCADE's: it prints this model.
class Parts : public ToolTest {
 protected:
  explicit Parts() {
    model_.shapes = {channel()};
    model_.unit = "mm";
  }

  void place(const std::vector<Affine>& placements) {
    model_.instances.clear();
    for (const Affine& placement : placements)
      model_.instances.push_back({.first_surface = 2 * model_.instances.size(),
                                  .name = "at_" + std::to_string(model_.instances.size()),
                                  .placement = placement,
                                  .colour = Colour{0, 0, 1}});
    model_.surfaces = value_of(placed_faces(model_.shapes, model_.instances));
  }
  /// Runs tessellate on a file that the program reads as the model.
  ToolRun tessellate(const std::string& output, const std::vector<std::string>& options = {}) {
    const std::string bytes = to_bytes(model_);
    std::string size(sizeof(std::uint64_t), '\0');
    const std::uint64_t count = bytes.size();
    std::memcpy(size.data(), &count, sizeof count);
    folder_.file("bytes", cad_reader_greeting() + size + bytes);
    folder_.file("part.igs", "ISO-10303-21;");
    const std::string reader = folder_.file("reader", "#!/bin/sh\ncat '" + (folder_ / "bytes") + "'\n");
    std::filesystem::permissions(reader, std::filesystem::perms::owner_all);
    std::vector<std::string> command{"tessellate", "part.igs", "-o", output};
    command.insert(command.end(), options.begin(), options.end());
    return run(command, {"TESSERA_CAD_READER=" + reader});
  }
  json facts(const std::string& output, std::vector<std::string> options = {}) {
    options.push_back("--json");
    const ToolRun result = tessellate(output, options);
    EXPECT_EQ(result.status, 0) << result.errors;
    return json::parse(result.output);
  }
  json gltf(const std::string& name) const { return json::parse(content_of(folder_ / name)); }

  /// The largest distance of centres of triangles from the surface of an instance, each measured along the instance's
  /// own axes: within a tenth above the true one where the surface is not steep.
  static double error(const Mesh& mesh, std::size_t first, std::size_t count, const Affine& placement) {
    const Vec3 z = placement.vector({0, 0, 1});
    double largest = 0;
    for (std::size_t k = 3 * first; k < 3 * (first + count); k += 3) {
      Vec3 centre = mesh.origin - placement.translation;
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const std::size_t v = 3 * mesh.indices[k + corner];
        centre += 1.0 / 3 * Vec3{mesh.positions[v], mesh.positions[v + 1], mesh.positions[v + 2]};
      }
      const std::array<Vec3, 3>& c = placement.columns;  // orthogonal
      const double x = dot(centre, c[0]) / dot(c[0], c[0]), height = dot(centre, c[2]) / dot(c[2], c[2]);
      if (height < 1.5 && std::abs(x) < 0.2) largest = std::max(largest, std::abs(height - x * x) * length(z));
    }
    return largest;
  }

  Model model_;
};

TEST_F(Parts, AShapeIsMeshedOnceAndStandsInManyPlaces) {
  place({{}});
  const json one = facts("one.gltf", {"--tolerance", "0.001"});
  std::vector<Affine> many;
  for (int k = 0; k < 50; ++k) many.push_back(Affine::translated({3.0 * k, 0, 0}) * Affine::rotated({0, 0, 1}, k));
  place(many);
  const json all = facts("all.gltf", {"--tolerance", "0.001"});
  EXPECT_EQ(all["triangles"], 50 * one["triangles"].get<int>());
  EXPECT_EQ(all["vertices"], 50 * one["vertices"].get<int>());
  EXPECT_EQ(all["patches"], 100);
  EXPECT_EQ(all["shapes"], 1);
  EXPECT_EQ(all["instances"], 50);
  EXPECT_NEAR(all["bound"].get<double>(), one["bound"].get<double>(), 1e-9);
  const json first = gltf("one.gltf"), file = gltf("all.gltf");
  EXPECT_EQ(file["buffers"], first["buffers"]);
  ASSERT_EQ(file["nodes"].size(), 51u);
  EXPECT_EQ(file["nodes"][0]["matrix"],
            json({0.001, 0.0, 0.0, 0.0, 0.0, 0.0, -0.001, 0.0, 0.0, 0.001, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0}));
  EXPECT_EQ(file["nodes"][7]["name"], "at_6");
  ASSERT_EQ(file["meshes"].size(), 1u);
  EXPECT_EQ(file["meshes"][0]["name"], "channel");
  EXPECT_EQ(file["meshes"][0]["primitives"].size(), 2u);  // red, and blue of the instances
  EXPECT_EQ(file["materials"][1]["pbrMetallicRoughness"]["baseColorFactor"], json({1.0, 0.0, 0.0, 1.0}));
  EXPECT_EQ(file["materials"][2]["pbrMetallicRoughness"]["baseColorFactor"], json({0.0, 0.0, 1.0, 1.0}));
  EXPECT_EQ(facts("all.ply", {"--tolerance", "0.001"})["triangles"], all["triangles"]);
  EXPECT_EQ(value_of(read_mesh(folder_ / "all.ply")).triangle_count(), all["triangles"]);
}

TEST_F(Parts, ShapesSideBySideGiveWhatOneThreadGives) {
  const Shape one = channel();
  std::vector<Instance> instances;
  for (std::size_t k = 0; k < 150; ++k) {
    model_.shapes.resize(k + 1, one);
    model_.shapes[k].name = "shape " + std::to_string(k);
    if (k % 7 == 3) model_.shapes[k].faces.pop_back();
    const Affine placement = Affine::scaled({1 + 0.1 * double(k), 1, 1 + double(k % 11)});
    instances.push_back({.shape = static_cast<std::uint32_t>(k), .placement = placement});
  }
  for (std::size_t k = 1; k < instances.size(); ++k)
    instances[k].first_surface = instances[k - 1].first_surface + model_.shapes[k - 1].faces.size();
  model_.instances = instances;
  model_.surfaces = value_of(placed_faces(model_.shapes, model_.instances));
  const auto both = [&](const std::string& name, std::vector<std::string> options) {
    options.insert(options.end(), {"--threads", "1"});
    const ToolRun alone = tessellate("one" + name, options);
    options.back() = "4";
    const ToolRun together = tessellate("four" + name, options);
    EXPECT_EQ(alone.status, together.status);
    EXPECT_EQ(alone.errors, together.errors);
    if (alone.status == 0) {
      EXPECT_TRUE(content_of(folder_ / ("one" + name)) == content_of(folder_ / ("four" + name)));
    }
    return alone.errors;
  };
  EXPECT_EQ(both(".glb", {"--tolerance", "0.001"}), "");
  EXPECT_EQ(both(".ply", {"--tolerance", "0.001"}), "");
  // The first shape, by their order, with which the meshes are too large.
  EXPECT_NE(both(".glb", {"--tolerance", "0.001", "--max-triangles", "2000"}).find("shape "), std::string::npos);
}

TEST_F(Parts, TheToleranceIsALengthOfTheModel) {
  const std::vector<Affine> places{Affine::translated({-9, 0, 0}),
                                   Affine::translated({50, 0, 0}) * Affine::scaled({10, 10, 10}),
                                   Affine::scaled({1, 1, -4}), Affine::scaled({0.1, 0.1, 0.1})};
  place(places);
  for (const char* const name : {"a.ply", "a.glb"}) {
    const double metre = std::string(name) == "a.glb" ? 1e-3 : 1;
    for (const double tolerance : {0.1, 0.003}) {
      const json all = facts(name, {"--tolerance", std::to_string(tolerance)});
      EXPECT_LE(all["bound"], tolerance);
      EXPECT_GT(all["bound"], tolerance / 5);
      EXPECT_EQ(all["tolerance"], tolerance);
      const Mesh mesh = value_of(read_mesh(folder_ / name));
      EXPECT_EQ(value_of(check(mesh)).flipped_triangles, 0u);
      const std::size_t each = mesh.triangle_count() / places.size();
      double largest = 0;
      for (std::size_t k = 0; k < places.size(); ++k) {
        const Affine placed = Affine::scaled({metre, metre, metre}) * places[k];
        largest = std::max(largest, error(mesh, k * each, each, placed) / metre);
      }
      EXPECT_LE(largest, 1.1 * all["bound"].get<double>()) << name;
      EXPECT_GT(largest, 0.1 * tolerance) << name;  // the largest instance needs it
    }
  }
  // A share is that of the whole model, as one set has it too.
  const double size = facts("a.glb", {"--relative", "0.01"})["tolerance"].get<double>() / 0.01;
  const json one_set = facts("b.glb", {"--relative", "0.01", "--pixels", "1e6", "--camera=0,-99,9,0,0,0,40"});
  EXPECT_NEAR(one_set["tolerance"].get<double>() / 0.01, size, 1e-6 * size);
}

TEST_F(Parts, OptionsForTheWholeModelGoOnWorking) {
  place({{}, Affine::translated({5, 0, 0}), Affine::translated({0, 9, 0}) * Affine::scaled({1, 1, 3})});
  const json few = facts("a.gltf", {"--triangles", "200"});
  EXPECT_LE(few["triangles"], 200);
  EXPECT_GT(few["triangles"], 50);
  EXPECT_EQ(gltf("a.gltf")["nodes"].size(), 7u);  // a node for each surface
  EXPECT_EQ(gltf("a.gltf")["materials"].size(), 3u);
  EXPECT_LE(facts("a.gltf", {"--pixels", "0.5", "--camera=0,-20,9,0,0,0,40"})["pixels"], 0.5);
  // The third place stretches normals too, so an angle needs one set of all; without it shapes will do.
  EXPECT_LE(facts("a.gltf", {"--angle", "5"})["angle"], 5.0);
  EXPECT_EQ(gltf("a.gltf")["nodes"].size(), 7u);
  place({{}, Affine::translated({5, 0, 0})});
  EXPECT_LE(facts("a.gltf", {"--angle", "5"})["angle"], 5.0);
  EXPECT_EQ(gltf("a.gltf")["nodes"].size(), 3u);
  EXPECT_EQ(facts("a.gltf", {"--grid", "4x3"})["triangles"], 2 * 2 * 24);
  const json quads = facts("a.ply", {"--grid", "4x3", "--quads"});
  EXPECT_EQ(quads["quads"], 2 * 2 * 12);
  EXPECT_EQ(value_of(read_mesh(folder_ / "a.ply", {.keep_quads = true})).quad_count(), 2u * 2 * 12);
  EXPECT_EQ(facts("a.obj", {"--precision", "double", "--tolerance", "1e-6"})["precision"], "double");
}

TEST_F(Parts, TextSaysWhatThePartIs) {
  model_.shapes[0].solid_count = 1;
  place({{}, Affine::translated({5, 0, 0})});
  const ToolRun result = tessellate("a.glb");
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_EQ(result.output.find("a.glb: 2 solids (1 shape at 2 places), "), 0u) << result.output;
  EXPECT_NE(result.output.find(", proven (--relative 0.001, the default), "), std::string::npos) << result.output;
  EXPECT_EQ(result.output.substr(result.output.size() - 3), " s\n") << result.output;
  EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 1);
}

TEST_F(Parts, TooSmallTolerancesAndLimitsAreRefused) {
  place({{}, Affine::translated({1e6, 0, 0})});
  const ToolRun flat = tessellate("a.ply", {"--tolerance", "0.01", "--precision", "float"});
  EXPECT_EQ(flat.status, 1);
  EXPECT_EQ(flat.errors.find("tessera: part.igs: the tolerance 0.01 must be above 0.06, the rounding of all instances"),
            0u)
      << flat.errors;
  EXPECT_LE(facts("a.ply", {"--tolerance", "0.01", "--precision", "double"})["bound"], 0.01);
  EXPECT_LE(facts("a.glb", {"--tolerance", "0.0001"})["bound"], 0.0001);
  const ToolRun many = tessellate("b.ply", {"--tolerance", "0.1", "--precision", "double", "--max-triangles", "19"});
  EXPECT_EQ(many.status, 1);
  EXPECT_NE(many.errors.find("take 20 triangles, the limit is 19"), std::string::npos) << many.errors;
  const ToolRun large = tessellate("b.glb", {"--grid", "256x256", "--max-memory", "1M"});
  EXPECT_NE(large.errors.find("part.igs: a mesh of 262144 triangles needs "), std::string::npos) << large.errors;
}

TEST_F(Parts, FilesWithAndWithoutShapesBecomeOneMesh) {
  place({{}, Affine::translated({5, 0, 0})});
  const json both = facts("a.gltf", {teapot, "--grid", "2x2"});
  EXPECT_EQ(both["surfaces"], 36);
  EXPECT_EQ(gltf("a.gltf")["nodes"].size(), 37u);
}

}}  // namespace tessera::test
