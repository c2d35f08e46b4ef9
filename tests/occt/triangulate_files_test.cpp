// Triangulations of the CAD files of TESSERA_TEST_DATA, each in a process of its own, since some crash OpenCASCADE.

#include <gtest/gtest.h>

#include <opencascade/BRepCheck_Analyzer.hxx>
#include <opencascade/BRepGProp.hxx>
#include <opencascade/GProp_GProps.hxx>
#include <opencascade/TopExp_Explorer.hxx>

#include <sys/wait.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "io_occt/cad_shapes.h"
#include "occt/poly_checks.h"
#include "tessera/cad.h"
#include "tessera/occt_mesh.h"

namespace tessera::test { namespace {

namespace fs = std::filesystem;

constexpr char name_of_file[] = "TESSERA_TEST_OCCT_FILE";
constexpr std::uintmax_t max_bytes = 4'000'000;

constexpr const char* marker = "read by OpenCASCADE";

/// All files of the data, those of cad_corpus too.
std::vector<fs::path> files() {
  std::vector<fs::path> all;
  const char* const data = std::getenv("TESSERA_TEST_DATA");
  if (!data) return all;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(data))
    if (entry.is_regular_file() && is_cad_file(entry.path()) && entry.file_size() <= max_bytes)
      all.push_back(entry.path());
  std::ranges::sort(all);
  return all;
}

/// Whether all faces stand at one place: else rounding may leave cracks in single precision.
bool has_one_place(const TopoDS_Shape& shape) {
  TopExp_Explorer face(shape, TopAbs_FACE);
  const TopLoc_Location place = face.Current().Location();
  for (; face.More(); face.Next())
    if (face.Current().Location() != place) return false;
  return true;
}

void check_file(const fs::path& path) {
  const Result<DescribedShape> file = load_cad(path);
  if (!file || file->shape.IsNull() || !TopExp_Explorer(file->shape, TopAbs_FACE).More()) return;
  const TopoDS_Shape& shape = file->shape;
  const double size = size_of(shape);
  const bool was_valid = BRepCheck_Analyzer(shape).IsValid();
  GProp_GProps exact;
  BRepGProp::VolumeProperties(shape, exact, false, false, false);
  std::printf("%s\n", marker);  // from here on, a crash is ours
  std::fflush(stdout);
  const Result<OcctMeshReport> made = triangulate(shape, {.deflection = 1e-3 * size});
  if (!made) {
    EXPECT_FALSE(was_valid) << made.status().message();
    return;
  }
  const PolyFacts facts = check_polys(shape, *made);
  const StlFacts stl = stl_facts(shape);
  std::printf("%s, %s, %zu faces, %zu left out, %zu faults, %zu triangles, %zu violations\n",
              was_valid ? "valid" : "not valid", made->closed ? "closed" : "open", made->faces, made->left_out.size(),
              made->faults.size(), made->triangles, facts.violations);
  for (const std::string& one : facts.wrong) std::printf("  %s\n", one.c_str());
  EXPECT_EQ(facts.triangles, made->triangles);
  if (made->closed && has_one_place(shape)) {
    EXPECT_EQ(stl.open_sides, 0u);
  }
  if (!was_valid) return;
  EXPECT_TRUE(BRepCheck_Analyzer(shape).IsValid());
  EXPECT_EQ(facts.violations, 0u);
  const bool is_solid = !TopExp_Explorer(shape, TopAbs_FACE, TopAbs_SOLID).More();
  if (!made->closed || !made->certified || !is_solid) return;
  EXPECT_NEAR(stl.volume, exact.Mass(), stl.area * (made->bound + made->gap) + 1e-5 * std::abs(exact.Mass()));
}

TEST(TriangulateFiles, OneFile) {
  const char* const path = std::getenv(name_of_file);
  if (!path) GTEST_SKIP() << name_of_file << " is not set";
  check_file(path);
}

TEST(TriangulateFiles, KeepWhatOpenCascadeExpects) {
  const std::vector<fs::path> all = files();
  if (all.empty()) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  const std::string self = fs::read_symlink("/proc/self/exe").string();
  std::size_t checked = 0;
  for (const fs::path& path : all) {
    ::setenv(name_of_file, path.c_str(), 1);
    std::FILE* const child = ::popen(
        ("timeout 120 '" + self + "' --gtest_filter=TriangulateFiles.OneFile --gtest_brief=1 2>&1").c_str(), "r");
    ASSERT_TRUE(child);
    std::string said;
    for (char line[512]; std::fgets(line, sizeof line, child);) said += line;
    const int status = ::pclose(child);
    checked += said.find("triangles") != std::string::npos;
    const bool ran = said.find("PASSED") != std::string::npos || said.find("FAILED") != std::string::npos;
    const bool is_ours = ran || said.find(marker) != std::string::npos;
    if (!is_ours) std::printf("%s: no end or a crash\n", path.c_str());  // of OpenCASCADE's reader: see load_cad()
    EXPECT_TRUE(!is_ours || (WIFEXITED(status) && WEXITSTATUS(status) == 0)) << path << ":\n" << said;
  }
  ::unsetenv(name_of_file);
  std::printf("%zu of %zu files have triangulations\n", checked, all.size());
  EXPECT_GT(checked, 0u);
}

}}  // namespace tessera::test
