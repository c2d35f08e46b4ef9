// Meshes are read back as they were written, in each format; meshes that no file can hold are errors.

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>

#include "io/mesh/mesh_formats.h"
#include "io/mesh_samples.h"
#include "support/scratch_folder.h"
#include "support/synthetic_sets.h"
#include "tessera/io.h"

namespace tessera { namespace {

using test::Attributes;
using test::random_mesh;
using test::ScratchFolder;

class MeshFiles : public testing::TestWithParam<std::string> {
 protected:
  std::string path(std::string_view stem = "mesh") const { return folder_ / (std::string(stem) + GetParam()); }
  ScratchFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(Formats, MeshFiles, testing::Values(".obj", ".ply", ".PLY"),
                         [](const auto& format) { return format.param.substr(1); });

TEST_P(MeshFiles, EveryBitComesBack) {
  for (const bool normals : {false, true}) {
    for (const bool parameters : {false, true}) {
      const Mesh mesh = random_mesh(50, 80, {normals, parameters, false});
      ASSERT_TRUE(write_mesh(mesh, path()).ok());
      const Result<Mesh> read = read_mesh(path());
      ASSERT_TRUE(read.ok()) << read.status().message();
      EXPECT_EQ(read->positions, mesh.positions);
      EXPECT_EQ(read->normals, mesh.normals);
      EXPECT_EQ(read->parameters, mesh.parameters);
      EXPECT_EQ(read->indices, mesh.indices);
      EXPECT_EQ(read->origin, Vec3{});
    }
  }
  EXPECT_EQ(folder_.names().size(), 1u);
}

TEST_P(MeshFiles, BytesInMemoryAreThoseOfTheFile) {
  const Mesh mesh = random_mesh(500, 8000, {true, true, false});
  ASSERT_TRUE(write_mesh(mesh, path()).ok());
  const Result<std::string> bytes = mesh_bytes(mesh, path());
  ASSERT_TRUE(bytes.ok()) << bytes.status().message();
  EXPECT_TRUE(*bytes == test::content_of(path()));
  EXPECT_EQ(mesh_bytes(mesh, "m.xyz").status().code(), StatusCode::unsupported);
  EXPECT_EQ(mesh_bytes({}, path()).status().code(), StatusCode::invalid_argument);
  EXPECT_EQ(folder_.names().size(), 1u);
}

TEST_P(MeshFiles, PositionsInDoubleAreWritten) {
  Mesh mesh = random_mesh(50, 80, {true, true, false});
  for (std::size_t k = 0; k < mesh.positions.size(); ++k) mesh.model_positions.push_back(1e6 + mesh.positions[k] / 3.0);
  ASSERT_TRUE(write_mesh(mesh, path()).ok());
  std::ifstream file(path(), std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  std::vector<double> found;
  if (GetParam() == ".obj") {
    std::istringstream lines(bytes);
    for (std::string line; std::getline(lines, line);) {
      if (!line.starts_with("v ")) continue;
      std::istringstream numbers(line.substr(2));
      for (std::string number; numbers >> number;) found.push_back(std::stod(number));
    }
  } else {
    EXPECT_NE(bytes.find("property double x\nproperty double y\nproperty double z\nproperty float nx\n"), bytes.npos);
    const std::size_t body = bytes.find("end_header\n") + 11, record = 3 * 8 + 5 * 4;
    found.resize(mesh.model_positions.size());
    for (std::size_t k = 0; k < mesh.vertex_count(); ++k)
      std::memcpy(&found[3 * k], bytes.data() + body + k * record, 3 * sizeof(double));
  }
  EXPECT_EQ(found, mesh.model_positions);
  EXPECT_EQ(test::value_of(read_mesh(path())).normals, mesh.normals);
  mesh.model_positions[7] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(write_mesh(mesh, path()).code(), StatusCode::non_finite);
  mesh.model_positions.pop_back();
  EXPECT_EQ(write_mesh(mesh, path()).code(), StatusCode::count_mismatch);
}

/// A mesh of triangles and quads in three parts, one of triangles alone and one of nothing.
Mesh mesh_of_parts() {
  Mesh mesh = random_mesh(30, 9, {true, true, true});
  for (std::uint32_t k = 0; k < 4 * 7; ++k) mesh.quads.push_back((11 * k + 3) % 30);
  mesh.quad_patches = {0, 0, 1, 1, 1, 4, 4};
  mesh.parts = {{"a", 0, 4, 0, 5}, {"none", 4, 0, 5, 0}, {"b", 4, 3, 5, 0}, {"c", 7, 2, 5, 2}};
  return mesh;
}

TEST_P(MeshFiles, QuadsComeBack) {
  const Mesh mesh = mesh_of_parts(), split = test::value_of(split_quads(mesh));
  ASSERT_TRUE(write_mesh(mesh, path()).ok());
  const Mesh read = test::value_of(read_mesh(path(), {.keep_quads = true}));
  EXPECT_EQ(read.positions, mesh.positions);
  EXPECT_EQ(read.indices, mesh.indices);
  EXPECT_EQ(read.quads, mesh.quads);
  const Mesh triangles = test::value_of(read_mesh(path()));
  EXPECT_TRUE(triangles.quads.empty());
  EXPECT_EQ(triangles.indices.size(), split.indices.size());
  if (GetParam() == ".obj") {
    EXPECT_EQ(triangles.indices, split.indices);  // part by part
    const std::string text = test::content_of(path());
    EXPECT_NE(text.find("\ng a\n"), std::string::npos);
    EXPECT_EQ(text.find("\ng none\n"), std::string::npos);
  } else {
    EXPECT_EQ(read.patches, mesh.patches);
    EXPECT_EQ(read.quad_patches, mesh.quad_patches);
    EXPECT_EQ(triangles.patches.size(), split.patches.size());
  }
  Mesh quads_alone = mesh;
  quads_alone.indices.clear();
  quads_alone.patches.clear();
  quads_alone.parts.clear();
  ASSERT_TRUE(write_mesh(quads_alone, path()).ok());
  EXPECT_EQ(test::value_of(read_mesh(path(), {.keep_quads = true})).quads, mesh.quads);
}

TEST_P(MeshFiles, ExtremeFloatsComeBack) {
  Mesh mesh = random_mesh(4, 2, {false, false, false});
  const float denormal = std::numeric_limits<float>::denorm_min();
  mesh.positions = {0,
                    -0.0f,
                    1,
                    std::numeric_limits<float>::max(),
                    -std::numeric_limits<float>::max(),
                    std::numeric_limits<float>::min(),
                    denormal,
                    -denormal,
                    16777217.0f,
                    0.1f,
                    1.0f / 3,
                    -3e-39f};
  ASSERT_TRUE(write_mesh(mesh, path()).ok());
  const Result<Mesh> read = read_mesh(path());
  ASSERT_TRUE(read.ok()) << read.status().message();
  EXPECT_EQ(read->positions, mesh.positions);
}

TEST_P(MeshFiles, TheOriginIsAddedInDoubleAndRoundedOnce) {
  const Mesh mesh = random_mesh(20, 10, {}, {1000.1, -2e6, 1e-3});
  ASSERT_TRUE(write_mesh(mesh, path()).ok());
  const Result<Mesh> read = read_mesh(path());
  ASSERT_TRUE(read.ok()) << read.status().message();
  for (std::size_t k = 0; k < mesh.positions.size(); ++k) {
    const double origin = k % 3 == 0 ? 1000.1 : k % 3 == 1 ? -2e6 : 1e-3;
    EXPECT_EQ(read->positions[k], static_cast<float>(origin + static_cast<double>(mesh.positions[k])));
  }
}

TEST_P(MeshFiles, LargerThanTheBuffer) {
  const Mesh mesh = random_mesh(60000, 120000);
  ASSERT_TRUE(write_mesh(mesh, path()).ok());
  const Result<Mesh> read = read_mesh(path());
  ASSERT_TRUE(read.ok()) << read.status().message();
  EXPECT_EQ(read->positions, mesh.positions);
  EXPECT_EQ(read->indices, mesh.indices);
}

/// The formats that are written, read back or not.
class MeshWriters : public MeshFiles {};
INSTANTIATE_TEST_SUITE_P(Formats, MeshWriters, testing::Values(".obj", ".ply", ".stl", ".glb", ".gltf"),
                         [](const auto& format) { return format.param.substr(1); });

/// Meshes that no file can hold, with their errors.
std::vector<std::pair<StatusCode, Mesh>> bad_meshes() {
  std::vector<std::pair<StatusCode, Mesh>> cases;
  const Mesh good = random_mesh(5, 4);
  for (int k = 0; k < 19; ++k) cases.emplace_back(StatusCode::count_mismatch, good);
  cases[0].second.positions.pop_back();
  cases[1].second.normals.pop_back();
  cases[2].second.parameters.pop_back();
  cases[3].second.indices.pop_back();
  cases[4].second.patches.pop_back();
  cases[5].second.indices[7] = 5;
  cases[5].first = StatusCode::invalid_argument;
  cases[6].second.positions[4] = std::numeric_limits<float>::quiet_NaN();
  cases[6].first = StatusCode::non_finite;
  cases[7].second.origin.x = 1e39;
  cases[7].first = StatusCode::non_finite;
  cases[8].second.normals[5] = std::numeric_limits<float>::infinity();
  cases[8].first = StatusCode::non_finite;
  cases[9].second.parameters[9] = -std::numeric_limits<float>::quiet_NaN();
  cases[9].first = StatusCode::non_finite;
  cases[10].second = {};
  cases[10].first = StatusCode::invalid_argument;
  cases[11].second.parts = {{"a", 0, 3}};
  cases[12].second.parts = {{"a", 0, 3}, {"b", 2, 2}};
  cases[12].first = StatusCode::invalid_argument;
  cases[13].second.parts = {{"a", 0, 3}, {"b", 3, ~std::size_t{0}}};
  cases[13].first = StatusCode::invalid_argument;
  for (std::size_t k = 14; k < 19; ++k) cases[k].second.quads = {0, 1, 2, 3, 1, 2, 3, 4};
  cases[14].second.quads.pop_back();
  cases[15].second.quad_patches = {1};
  cases[16].second.quads[6] = 5;
  cases[16].first = StatusCode::invalid_argument;
  cases[17].second.parts = {{"a", 0, 4, 0, 1}};
  cases[18].second.parts = {{"a", 0, 4, 0, 1}, {"b", 4, 0, 2, 1}};
  cases[18].first = StatusCode::invalid_argument;
  return cases;
}

TEST_P(MeshWriters, BadMeshesAreRefusedAndNothingAppears) {
  const auto cases = bad_meshes();
  for (const auto& [code, mesh] : cases) {
    const Status status = write_mesh(mesh, path());
    EXPECT_EQ(status.code(), code) << status.message();
    EXPECT_EQ(status.message().rfind(path() + ": ", 0), 0u) << status.message();
  }
  EXPECT_EQ(write_mesh(cases[5].second, path()).index(), 7);
  EXPECT_EQ(write_mesh(cases[6].second, path()).index(), 1);
  EXPECT_EQ(write_mesh(cases[8].second, path()).index(), 1);
  EXPECT_EQ(write_mesh(cases[9].second, path()).index(), 4);
  EXPECT_EQ(write_mesh(cases[13].second, path()).index(), 1);
  EXPECT_EQ(write_mesh(cases[16].second, path()).index(), 6);
  EXPECT_TRUE(folder_.names().empty());
}

/// The first bad value is found among pieces of many threads.
TEST_P(MeshWriters, TheFirstOfSeveralBadVerticesIsNamed) {
  Mesh mesh = random_mesh(200000, 3);
  for (const std::size_t vertex : {199999u, 150001u, 70000u})
    mesh.positions[3 * vertex + 2] = std::numeric_limits<float>::infinity();
  EXPECT_EQ(write_mesh(mesh, path()).index(), 70000);
  EXPECT_TRUE(folder_.names().empty());
}

TEST_P(MeshWriters, QuadsBecomeTrianglesWhereThereIsNothingElse) {
  if (GetParam() == ".obj" || GetParam() == ".ply") return;
  const Mesh mesh = mesh_of_parts();
  ASSERT_TRUE(write_mesh(mesh, path()).ok());
  ASSERT_TRUE(write_mesh(test::value_of(split_quads(mesh)), path("split")).ok());
  EXPECT_EQ(test::content_of(path()), test::content_of(path("split")));
}

TEST_P(MeshWriters, MeshesWithoutTriangles) {
  const Status status = write_mesh(random_mesh(3, 0), path());
  const bool points_suffice = GetParam() == ".obj" || GetParam() == ".ply";
  EXPECT_EQ(status.ok(), points_suffice) << status.message();
  EXPECT_EQ(folder_.names().size(), points_suffice ? 1u : 0u);
}

TEST_P(MeshWriters, OutputsThatCannotBeWrittenAreErrors) {
  const Mesh mesh = random_mesh(5, 4);
  EXPECT_EQ(write_mesh(mesh, path("none/mesh")).code(), StatusCode::io_error);
  std::filesystem::create_directory(path("folder"));
  EXPECT_EQ(write_mesh(mesh, path("folder")).code(), StatusCode::io_error);
  std::filesystem::create_symlink("/dev/full", path("full"));
  EXPECT_EQ(write_mesh(mesh, path("full")).code(), StatusCode::io_error);
  EXPECT_EQ(folder_.names().size(), 2u);
}

/// Behaves like a disk that fills up.
TEST_P(MeshWriters, AFileThatMayNotGrowLeavesTheOldOne) {
  folder_.file("mesh" + GetParam(), "before");
  struct rlimit limit {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &limit), 0);
  std::signal(SIGXFSZ, SIG_IGN);
  struct rlimit small = limit;
  small.rlim_cur = 5'000'000;
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const Status status = write_mesh(random_mesh(150000, 250000), path());
  ::setrlimit(RLIMIT_FSIZE, &limit);
  EXPECT_EQ(status.code(), StatusCode::io_error);
  EXPECT_EQ(status.message(), path() + ": cannot be written: File too large");
  EXPECT_EQ(test::content_of(path()), "before");
  EXPECT_EQ(folder_.names().size(), 1u);
}

TEST_P(MeshFiles, TruncatedFilesNeverCrashNorGiveMoreThanTheyHold) {
  const Mesh mesh = random_mesh(6, 5);
  ASSERT_TRUE(write_mesh(mesh, path()).ok());
  const std::string bytes = test::content_of(path());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const bool obj = GetParam() == ".obj";
    const std::string_view cut = std::string_view(bytes).substr(0, size);
    const Result<Mesh> read = obj ? parse_obj(cut, "cut") : parse_ply(cut, "cut");
    if (obj) {  // states no counts: a cut text may be a shorter mesh
      EXPECT_TRUE(!read.ok() || read->triangle_count() <= mesh.triangle_count());
    } else {
      EXPECT_FALSE(read.ok()) << "cut at byte " << size;
    }
  }
}

TEST(Formats, UnknownOnesAreNamedWithThoseThatAreKnown) {
  const ScratchFolder folder;
  const std::string model = folder.file("a.k3d", "x"), none = folder.file("plain", "x"),
                    mesh = folder.file("b.off", "x");
  EXPECT_EQ(read_model(model).status().message(),
            model +
                ": unsupported format \".k3d\": surfaces are read as .bpt, .bv, "
                ".g2, .json, .obj, .rib, .brep, .brp, .iges, .igs, .p21, .step, .stp, .stpz");
  EXPECT_EQ(read_model(model).status().code(), StatusCode::unsupported);
  EXPECT_EQ(read_model(none).status().message(),
            none +
                ": unsupported format \"\": surfaces are read as .bpt, .bv, .g2, "
                ".json, .obj, .rib, .brep, .brp, .iges, .igs, .p21, .step, .stp, .stpz");
  EXPECT_EQ(read_mesh(mesh).status().message(),
            mesh + ": unsupported format \".off\": meshes are read as .obj, .ply, .stl, .glb, .gltf");
  EXPECT_EQ(write_mesh(random_mesh(3, 1), mesh).message(),
            mesh + ": unsupported format \".off\": meshes are written as .obj, .ply, .stl, .glb, .gltf");
  EXPECT_EQ(write_model(Model{}, mesh).status().message(),
            mesh + ": unsupported format \".off\": surfaces are written as .bpt, .json, .obj");
  EXPECT_EQ(test::content_of(mesh), "x");
}

TEST(Formats, WhatCannotBeOpenedIsSaidFirst) {
  const ScratchFolder folder;
  EXPECT_EQ(read_model(folder / "missing.k3d").status().code(), StatusCode::io_error);
  EXPECT_EQ(read_model(folder.path()).status().message(), folder.path().string() + ": is a directory, not a file");
  EXPECT_EQ(read_mesh(folder / "missing.ply").status().message(),
            (folder / "missing.ply") + ": cannot be opened: No such file or directory");
  EXPECT_EQ(read_mesh(folder.file("empty.obj", "")).status().message(), (folder / "empty.obj") + ": the file is empty");
}

}}  // namespace tessera
