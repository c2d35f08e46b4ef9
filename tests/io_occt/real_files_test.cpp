// Known facts of some STEP and IGES files of TESSERA_TEST_DATA. tests/conformance checks that each is read.

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "io_occt/cad_shapes.h"
#include "support/scratch_folder.h"
#include "tessera/cad.h"

namespace tessera::test { namespace {

const Model* find(const std::vector<std::filesystem::path>& files, const char* name, Result<Model>& model) {
  for (const std::filesystem::path& path : files)
    if (path.filename() == name) model = read_by_opencascade(path);
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

}}  // namespace tessera::test
