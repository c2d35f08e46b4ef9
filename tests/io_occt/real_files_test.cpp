// Every STEP and IGES file of TESSERA_TEST_DATA, and what is read of it.

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <sstream>

#include "io_occt/cad_shapes.h"
#include "support/scratch_folder.h"
#include "tessera/io_occt.h"

namespace tessera::test {
namespace {

/// How often each word of a form "=WORD(" stands in a STEP file.
std::size_t count_of(const std::string& text, const std::string& word) {
  std::size_t count = 0;
  for (std::size_t place = text.find(word); place != std::string::npos; place = text.find(word, place + 1)) ++count;
  return count;
}

/// Independent entities of an IGES file by type, from the first lines of its directory entries: columns 1-8 are the type,
/// 69-70 of the status say whether the entity depends on another one (00: on none).
std::map<int, int> independent_types(const std::string& text) {
  std::map<int, int> types;
  std::istringstream stream(text);
  int entry_line = 0;
  for (std::string line; std::getline(stream, line);) {
    if (line.size() <= 72 || line[72] != 'D' || ++entry_line % 2 == 0) continue;
    const std::string status = line.substr(64, 8);
    if (status.substr(2, 2) == "00" || status.substr(2, 2) == "  " || status.substr(2, 2) == " 0")
      ++types[std::atoi(line.substr(0, 8).c_str())];
  }
  return types;
}

std::size_t expected_at_least(const std::filesystem::path& path) {
  const std::string text = content_of(path);
  if (path.extension().string().starts_with(".st"))
    return count_of(text, "ADVANCED_FACE(") + count_of(text, "FACE_SURFACE(");
  std::size_t surfaces = 0;
  for (const auto& [type, count] : independent_types(text))
    for (const int surface : {114, 118, 120, 122, 128, 140, 143, 144})
      if (type == surface) surfaces += static_cast<std::size_t>(count);
  return surfaces;
}

TEST(RealCadFiles, AreReadOrRefusedWithTheirReason) {
  const std::vector<std::filesystem::path> files = real_cad_files();
  if (files.empty()) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  std::printf("%-50s %8s %8s\n", "file", "surfaces", "trimmed");
  std::size_t read = 0, surfaces = 0;
  for (const std::filesystem::path& path : files) {
    const std::string file = path.filename().string();
    const std::size_t least = expected_at_least(path);
    const Result<Model> model = read_cad(path);
    if (!model) {
      std::printf("%-50s refused: %s\n", file.c_str(), model.status().message().c_str() + path.string().size() + 2);
      EXPECT_EQ(least, 0u) << model.status().message();
      EXPECT_NE(model.status().message().find("it holds no surfaces"), std::string::npos) << model.status().message();
      continue;
    }
    std::size_t trimmed = 0;
    for (const ModelSurface& surface : model->surfaces) trimmed += !surface.trims->empty();
    std::printf("%-50s %8zu %8zu\n", file.c_str(), model->surfaces.size(), trimmed);
    for (const std::string& warning : model->warnings)
      std::printf("    %s\n", warning.c_str() + path.string().size() + 2);
    EXPECT_GE(model->surfaces.size(), least) << path;
    ++read;
    surfaces += model->surfaces.size();
  }
  std::printf("%zu files, %zu read, %zu surfaces\n", files.size(), read, surfaces);
  EXPECT_GE(read, 30u);
}

const Model* find(const std::vector<std::filesystem::path>& files, const char* name, Result<Model>& model) {
  for (const std::filesystem::path& path : files)
    if (path.filename() == name) model = read_cad(path);
  return model.ok() ? &*model : nullptr;
}

TEST(RealCadFiles, AssembliesHaveNamesAndPlaces) {
  const std::vector<std::filesystem::path> files = real_cad_files();
  if (files.empty()) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  Result<Model> result = Status(StatusCode::io_error, "no such file");
  const Model* const model = find(files, "as1-oc-214.stp", result);
  ASSERT_TRUE(model) << result.status().message();
  std::map<std::string, std::set<double>> places;  // of each part, along x
  std::map<std::string, std::size_t> faces;
  for (const ModelSurface& surface : model->surfaces) {
    places[surface.name].insert(surface.placement->point({}).x);
    ++faces[surface.name];
  }
  // The classic: a plate, two brackets with three bolts each, a rod; nuts on all of these.
  ASSERT_EQ(faces.size(), 5u);
  for (const char* const name : {"plate", "l-bracket", "bolt", "rod", "nut"}) EXPECT_TRUE(faces.contains(name)) << name;
  EXPECT_EQ(faces["nut"] % 8, 0u);
  EXPECT_EQ(faces["bolt"] % 6, 0u);
  EXPECT_GT(places["nut"].size(), 1u);
  EXPECT_EQ(places["plate"].size(), 1u);
}

TEST(RealCadFiles, DomainsSmallerThanTheKnotsAreKept) {
  const std::vector<std::filesystem::path> files = real_cad_files();
  if (files.empty()) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  Result<Model> result = Status(StatusCode::io_error, "no such file");
  const Model* const model = find(files, "occt_hammer.iges", result);
  ASSERT_TRUE(model) << result.status().message();
  std::size_t smaller = 0;
  for (const ModelSurface& surface : model->surfaces) {
    const BSplineSurface& s = std::get<BSplineSurface>(surface.surface);
    const Domain& d = s.domain();
    smaller += d.u0 > s.knots_u().front() || d.u1 < s.knots_u().back() || d.v0 > s.knots_v().front() ||
               d.v1 < s.knots_v().back();
  }
  std::printf("%zu of %zu domains are smaller than the knots\n", smaller, model->surfaces.size());
  EXPECT_GT(smaller, 0u);
}

}  // namespace
}  // namespace tessera::test
