// Real models in parts have the meshes of the whole.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "parts/joined_parts.h"
#include "support/random_patches.h"
#include "support/real_files.h"
#include "tessera/io.h"

namespace tessera::test { namespace {

std::vector<std::filesystem::path> real_models() {
  std::vector<std::filesystem::path> paths;
  const char* const folder = std::getenv("TESSERA_TEST_DATA");
  if (!folder) return paths;
  for (const std::filesystem::path& file : files_below(folder))
    if (std::filesystem::file_size(file) < 3'000'000) paths.push_back(file);
  return paths;
}

TEST(RealParts, HaveTheMeshOfTheWhole) {
  const std::vector<std::filesystem::path> paths = real_models();
  if (paths.empty()) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  Random random(11);
  std::size_t models = 0, meshes = 0, trimmed = 0, different = 0;
  for (const std::filesystem::path& path : paths) {
    const Result<Model> model = read_model(path);
    if (!model || model->surfaces.empty() || model->surfaces.size() > 600) continue;
    const std::size_t count = model->surfaces.size();
    ++models;
    trimmed += model->instances.empty() ? 0 : 1;
    for (const double tolerance : {1e-2, 1e-3}) {
      const TessellationOptions options{.tolerance = tolerance, .relative = true, .max_triangles = 2'000'000};
      const Result<Mesh> whole = whole_mesh(*model, options);
      if (!whole) continue;
      for (const std::size_t parts : {2, 3, 7, 20}) {
        std::vector<std::size_t> ends{count};
        while (ends.size() < parts) ends.push_back(std::uniform_int_distribution<std::size_t>(0, count)(random));
        std::ranges::sort(ends);
        const Result<Mesh> mesh = mesh_in_parts(*model, ends, options);
        ASSERT_TRUE(mesh) << path << ": " << mesh.status().message();
        const std::string fault = difference(*whole, *mesh);
        ++meshes;
        different += fault.empty() ? 0 : 1;
        EXPECT_EQ(fault, "") << path << " at " << tolerance << " in " << parts << " parts";
      }
    }
  }
  std::printf("%zu models, %zu of CAD, %zu meshes in parts, %zu different\n", models, trimmed, meshes, different);
  EXPECT_GT(models, 40u);
}

}}  // namespace tessera::test
