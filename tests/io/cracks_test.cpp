// Certified meshes of models, the project's and those of TESSERA_TEST_DATA, have no cracks. More files, tolerances and
// STEP and IGES: bench/tess/crack_report.cpp.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <set>

#include "support/crack_survey.h"
#include "support/real_files.h"
#include "tessera/io.h"

namespace tessera::test { namespace {

/// The models below a folder, in order.
std::set<std::filesystem::path> models_below(const std::filesystem::path& folder) {
  const std::set<std::string> known{".bpt", ".bv", ".g2", ".json", ".obj", ".rib"};
  std::set<std::filesystem::path> models;
  for (const std::filesystem::path& file : files_below(folder))
    if (known.contains(file.extension().string())) models.insert(file);
  return models;
}

/// How many models made meshes.
std::size_t expect_no_cracks(const std::filesystem::path& folder) {
  std::size_t meshed = 0;
  for (const std::filesystem::path& path : models_below(folder)) {
    const Result<Model> model = read_model(path);
    const Result<PatchSet> set = model ? make_patch_set(*model) : Result<PatchSet>(model.status());
    if (!set) continue;
    struct Case {
      double relative;
      bool fewest;
    };
    for (const auto& [relative, fewest] : {Case{1e-2, false}, Case{1e-3, false}, Case{1e-3, true}}) {
      const Result<CrackCount> count = count_cracks(*set, relative, 50000, fewest);
      EXPECT_TRUE(count.ok()) << path << ": " << count.status().message();
      if (!count) continue;
      EXPECT_TRUE(count->good()) << path << " at " << relative << ": " << count->cracks << " cracks, "
                                 << count->non_manifold << " non-manifold edges, " << count->report.degenerate_triangles
                                 << " degenerate triangles, " << count->report.non_finite_vertices
                                 << " vertices with NaN";
      // Edges of triangles without area are not counted here.
      if (count->report.degenerate_triangles == 0) {
        EXPECT_EQ(count->own_edges + count->cracks, count->report.open_edges) << path;
      }
      meshed += relative == 1e-2;
    }
  }
  return meshed;
}

TEST(Cracks, NoneInTheModelsOfTheProject) {
  EXPECT_GE(expect_no_cracks(std::filesystem::path(TESSERA_SOURCE_DIR) / "tools" / "models"), 60u);
}

TEST(Cracks, NoneInRealModels) {
  const char* const data = std::getenv("TESSERA_TEST_DATA");
  if (data == nullptr) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  EXPECT_GE(expect_no_cracks(data), 20u);
}

/// The survey itself finds a slit.
TEST(Cracks, AreFoundWhereVerticesPart) {
  const Result<Model> model = read_model(std::filesystem::path(TESSERA_SOURCE_DIR) / "tools" / "models" / "teapot.bpt");
  ASSERT_TRUE(model.ok());
  const Result<PatchSet> set = make_patch_set(*model);
  ASSERT_TRUE(set.ok());
  const MeetingBorders borders(*set, {});
  const Result<Tessellation> plan = Tessellation::make(*set, {.tolerance = 0.05});
  ASSERT_TRUE(plan.ok());
  Mesh mesh = plan->allocate().value();
  ASSERT_TRUE(plan->run(*set, mesh.views()).ok());
  CrackCount whole, torn;
  count_edges(mesh, borders, whole);
  EXPECT_EQ(whole.cracks, 0u);
  for (std::size_t k = 0; k < mesh.vertex_count(); ++k)  // the border v = 0 of the first patch
    if (mesh.parameters[2 * k] > 0 && mesh.parameters[2 * k] < 1 && mesh.parameters[2 * k + 1] == 0) {
      mesh.positions[3 * k] += 0.01f;
      break;
    }
  count_edges(mesh, borders, torn);
  EXPECT_GT(torn.cracks + torn.own_edges, whole.own_edges);
}

}}  // namespace tessera::test
