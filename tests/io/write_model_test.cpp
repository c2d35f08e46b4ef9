// Surfaces are read back as they were written: the same patches over the same parameters, under the same names.

#include <cmath>
#include <iostream>

#include "io/written_models.h"
#include "support/real_files.h"

namespace tessera::test { namespace {

const std::filesystem::path models = TESSERA_SOURCE_DIR "/tools/models";

class WriteModel : public testing::Test {
 protected:
  void expect_refused(const Model& model, const std::string& name, StatusCode code, const std::string& message) {
    const auto before = folder_.names();
    const Result<WrittenModel> written = write_model(model, folder_ / name);
    ASSERT_FALSE(written.ok()) << name;
    EXPECT_EQ(written.status().code(), code) << written.status().message();
    EXPECT_EQ(written.status().message(), (folder_ / name) + ": " + message);
    EXPECT_EQ(folder_.names(), before);
  }
  ScratchFolder folder_;
};

TEST_F(WriteModel, EveryDegreeComesBackBitForBit) {
  Random random(1);
  for (int m = 1; m <= max_degree; ++m)
    for (int n = 1; n <= max_degree; n += 1 + m % 3) {
      const Model polynomials = model_of({random_polynomial(random, m, n), random_polynomial(random, n, m, {}, 1e-300),
                                          random_polynomial(random, m, n, {1e15, -1e300, 1}, 1e280)});
      for (const char* name : {"a.bpt", "a.json", "a.obj"}) {
        WrittenModel facts;
        const Model read = rewritten(polynomials, folder_ / name, &facts);
        EXPECT_EQ(facts.surfaces, 3u);
        EXPECT_EQ(facts.patches, 3u);
        EXPECT_EQ(facts.fit_error.distance, 0);
        EXPECT_TRUE(facts.warnings.empty());
        expect_same_patches(polynomials, read, name);
        for (const ModelSurface& surface : read.surfaces)
          EXPECT_TRUE(std::holds_alternative<BezierPatch>(surface.surface));
      }
      const Model rationals = model_of({random_rational(random, m, n), random_rational(random, n, m, 1e-3, 1e5)});
      for (const char* name : {"a.json", "a.obj"}) {
        const Model read = rewritten(rationals, folder_ / name);
        for (std::size_t k = 0; k < 2; ++k) {  // patches on [0,1]^2 are never multiplied by their weights
          const auto& a = std::get<BezierPatch>(rationals.surfaces[k].surface);
          const auto& b = std::get<BezierPatch>(read.surfaces[k].surface);
          EXPECT_TRUE(std::equal(a.points().begin(), a.points().end(), b.points().begin(), b.points().end()));
          EXPECT_TRUE(std::equal(a.weights().begin(), a.weights().end(), b.weights().begin(), b.weights().end()));
        }
      }
    }
}

TEST_F(WriteModel, EveryModelComesBack) {
  std::size_t count = 0;
  for (const auto& file : files_below(models)) {
    if (file.extension() != ".json" && file.extension() != ".bpt") continue;
    const Model model = value_of(read_model(file));
    for (const char* name : {"a.json", "a.obj"}) {
      WrittenModel facts;
      const Model read = rewritten(model, folder_ / name, &facts);
      EXPECT_TRUE(facts.warnings.empty()) << file;
      expect_same_patches(model, read, file.string());
      PatchSetOptions whole;
      whole.trims = false;
      const PatchSet set = value_of(make_patch_set(model, whole));
      EXPECT_EQ(facts.patches, set.patch_count()) << file;
      EXPECT_EQ(facts.fit_error.distance, set.fit_error().distance) << file;
      EXPECT_EQ(facts.fit_error.certified, set.fit_error().certified) << file;
    }
    ++count;
  }
  EXPECT_GE(count, 60u);
}

TEST_F(WriteModel, PatchesOfPolynomialModelsComeBackFromBpt) {
  std::size_t polynomial_models = 0;
  for (const auto& file : files_below(models)) {
    if (file.extension() != ".json" && file.extension() != ".bpt") continue;
    const Model model = value_of(read_model(file));
    const PatchSet set = value_of(make_patch_set(model));
    const auto weighted = [&](std::size_t k) {
      const auto w = set.patch(k).weights();
      return std::any_of(w.begin(), w.end(), [&](double x) { return x != w.front(); });
    };
    bool rational = false;
    for (std::size_t k = 0; k < set.patch_count(); ++k) rational |= weighted(k);
    const Result<WrittenModel> written = write_model(model, folder_ / "a.bpt");
    EXPECT_EQ(written.ok(), !rational) << file << written.status().message();
    if (rational) {
      EXPECT_EQ(written.status().code(), StatusCode::unsupported);
      continue;
    }
    ++polynomial_models;
    const Model read = value_of(read_model(folder_ / "a.bpt"));
    ASSERT_EQ(read.surfaces.size(), set.patch_count());
    for (std::size_t k = 0; k < set.patch_count(); ++k)
      expect_same_patches(set.patch(k), std::get<BezierPatch>(read.surfaces[k].surface), file.string());
  }
  EXPECT_GE(polynomial_models, 20u);
}

TEST_F(WriteModel, EveryFileOfOthersComesBack) {
  const char* const data = std::getenv("TESSERA_TEST_DATA");
  if (!data) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  std::size_t files = 0, surfaces = 0, trims = 0;
  for (const auto& file : files_below(data)) {
    const Result<Model> model = read_model(file);
    if (!model) continue;  // not a model, or an error: the readers' tests say which
    const Result<PatchSet> set = make_patch_set(*model);
    if (!set) continue;
    for (const char* name : {"a.json", "a.obj"}) {
      WrittenModel facts;
      const Model read = rewritten(*model, folder_ / name, &facts);
      EXPECT_TRUE(facts.warnings.empty()) << file << ": " << facts.warnings.front();
      ASSERT_EQ(read.surfaces.size(), model->surfaces.size()) << file;
      for (std::size_t k = 0; k < read.surfaces.size(); ++k) {
        ModelSurface named = model->surfaces[k];
        named.name = read.surfaces[k].name;  // names have tests of their own
        expect_same_patches(named, read.surfaces[k], file.string() + " surface " + std::to_string(k));
        // Quadrics may become nets, whose loops are those of the grid.
        const auto is_quadric = [](const ModelSurface& of) { return std::holds_alternative<QuadricPiece>(of.surface); };
        const bool by_grid = is_quadric(named) && !is_quadric(read.surfaces[k]);
        std::vector<TrimLoop> loops = by_grid ? *value_of(grid_trims(named)) : *named.trims;
        for (TrimLoop& loop : loops) loop.coedges.clear();  // the formats have no edges
        EXPECT_EQ(*read.surfaces[k].trims, loops) << file;
        trims += named.trims->size();
      }
    }
    ++files;
    surfaces += model->surfaces.size();
  }
  std::cout << files << " files, " << surfaces << " surfaces, " << trims << " trims\n";
  EXPECT_GE(files, 30u);
  EXPECT_GE(trims, 5u);
}

TEST_F(WriteModel, RationalPatchesAreNamedWhereTheFormatHasNoWeights) {
  Random random(2);
  Model model = model_of({random_polynomial(random, 2, 2), random_rational(random, 2, 1)});
  model.surfaces[1].name = "rim";
  expect_refused(model, "a.bpt", StatusCode::unsupported,
                 "surface 1 (rim): it is rational, but .bpt has no weights: write .obj");
  EXPECT_EQ(write_model(model, folder_ / "a.bpt").status().index(), 1);
  EXPECT_TRUE(folder_.names().empty());
}

TEST_F(WriteModel, NamesComeBackAsFarAsALineHoldsThem) {
  Random random(3);
  const std::vector<std::pair<std::string, std::string>> names{{"", ""},
                                                               {"rim", "rim"},
                                                               {"rim", "rim"},
                                                               {"", ""},
                                                               {"a b/c \"d\" \xc3\xa4#5", "a b/c \"d\" \xc3\xa4#5"},
                                                               {"two\nlines\tand \x01", "two lines and"},
                                                               {"# no comment # here", "_ no comment _ here"},
                                                               {"ends in \\", "ends in"},
                                                               {"f 1 2 3", "f 1 2 3"}};
  Model model;
  for (const auto& [name, expected] : names) model.surfaces.push_back({name, random_polynomial(random, 1, 1)});
  const Model read = rewritten(model, folder_ / "a.obj");
  ASSERT_EQ(read.surfaces.size(), names.size());
  for (std::size_t k = 0; k < names.size(); ++k) EXPECT_EQ(read.surfaces[k].name, names[k].second);
}

TEST_F(WriteModel, JsonKeepsEveryNameThatIsUtf8) {
  Random random(5);
  Model model;
  const std::vector<std::string> names{"", "rim", "two\nlines\tand \x01 \"quoted\" \\", "\xc3\xa4 # \xe2\x82\xac"};
  for (const std::string& name : names) model.surfaces.push_back({name, random_polynomial(random, 1, 1)});
  model.surfaces.push_back({"not UTF-8: \xff", random_polynomial(random, 1, 1)});
  const Model read = rewritten(model, folder_ / "a.json");
  ASSERT_EQ(read.surfaces.size(), names.size() + 1);
  for (std::size_t k = 0; k < names.size(); ++k) EXPECT_EQ(read.surfaces[k].name, names[k]);
  EXPECT_EQ(read.surfaces.back().name, "not UTF-8: \xef\xbf\xbd");
}

TEST_F(WriteModel, WhatCannotBeWrittenIsAnErrorAndLeavesWhatWasThere) {
  Random random(4);
  const Model model = model_of({random_polynomial(random, 3, 3)});
  expect_refused({}, "a.obj", StatusCode::invalid_argument, "the model has no surfaces");
  expect_refused(model, "a.ply", StatusCode::unsupported,
                 "unsupported format \".ply\": surfaces are written as .bpt, .json, .obj");
  std::filesystem::create_directory(folder_ / "folder.obj");
  expect_refused(model, "folder.obj", StatusCode::io_error, "cannot be written: it is a directory");
  expect_refused(model, "none/a.obj", StatusCode::io_error,
                 "cannot be written: there is no folder " + (folder_ / "none"));
  std::filesystem::create_symlink("/dev/full", folder_ / "full.obj");
  expect_refused(model, "full.obj", StatusCode::io_error, "cannot be written: No space left on device");
  folder_.file("old.bpt", "before");
  expect_refused(model_of({random_rational(random, 1, 1)}), "old.bpt", StatusCode::unsupported,
                 "surface 0: it is rational, but .bpt has no weights: write .obj");
  EXPECT_EQ(content_of(folder_ / "old.bpt"), "before");
  Model fitted = value_of(read_model(models / "seashell.json"));
  const Result<WrittenModel> unreachable = write_model(fitted, folder_ / "old.bpt", {.tolerance = 1e-30});
  EXPECT_FALSE(unreachable.ok());
  EXPECT_EQ(content_of(folder_ / "old.bpt"), "before");
}

}}  // namespace tessera::test
