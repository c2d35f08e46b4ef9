#pragma once
// Models that are written and read back.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "support/random_patches.h"
#include "support/scratch_folder.h"
#include "support/synthetic_sets.h"
#include "support/ulp.h"
#include "tessera/io.h"

namespace tessera::test {

inline Model model_of(std::vector<BezierPatch> patches) {
  Model model;
  for (BezierPatch& patch : patches) model.surfaces.push_back({{}, Surface(std::move(patch))});
  return model;
}

/// The model after writing and reading.
inline Model rewritten(const Model& model, const std::string& path, WrittenModel* facts = nullptr) {
  const Result<WrittenModel> written = write_model(model, path);
  EXPECT_TRUE(written.ok()) << written.status().message();
  if (facts && written) *facts = *written;
  return value_of(read_model(path));
}

/// Expects the same patch: control points by their bits. Rational ones may pass through w * p / w; their weights are
/// compared by ratios, because equal ones are dropped.
inline void expect_same_patches(const BezierPatch& a, const BezierPatch& b, const std::string& where) {
  ASSERT_EQ(a.degree_u(), b.degree_u()) << where;
  ASSERT_EQ(a.degree_v(), b.degree_v()) << where;
  const double tolerance = a.is_rational() ? 2 * double_unit : 0;
  for (int i = 0; i <= a.degree_u(); ++i)
    for (int j = 0; j <= a.degree_v(); ++j) {
      const Vec3 &p = a.point(i, j), &q = b.point(i, j);
      for (const auto& [x, y] : {std::pair{p.x, q.x}, std::pair{p.y, q.y}, std::pair{p.z, q.z}})
        ASSERT_LE(std::abs(x - y), tolerance * std::abs(x)) << where << " at " << i << ", " << j;
      const double w = a.weight(i, j) / a.weight(0, 0), x = b.weight(i, j) / b.weight(0, 0);
      ASSERT_LE(std::abs(w - x), 2 * tolerance * w) << where << " at " << i << ", " << j;
    }
}

/// Expects the same surface: name, ranges of parameters, patches.
inline void expect_same_patches(const ModelSurface& a, const ModelSurface& b, const std::string& where) {
  EXPECT_EQ(a.name, b.name) << where;
  const PatchGrid p = value_of(to_bezier(a)), q = value_of(to_bezier(b));
  ASSERT_TRUE(std::equal(p.breaks_u().begin(), p.breaks_u().end(), q.breaks_u().begin(), q.breaks_u().end())) << where;
  ASSERT_TRUE(std::equal(p.breaks_v().begin(), p.breaks_v().end(), q.breaks_v().begin(), q.breaks_v().end())) << where;
  for (std::size_t k = 0; k < p.patches().size(); ++k)
    expect_same_patches(p.patches()[k], q.patches()[k], where + " patch " + std::to_string(k));
}

inline void expect_same_patches(const Model& a, const Model& b, const std::string& where) {
  ASSERT_EQ(a.surfaces.size(), b.surfaces.size()) << where;
  for (std::size_t k = 0; k < a.surfaces.size(); ++k)
    expect_same_patches(a.surfaces[k], b.surfaces[k], where + " surface " + std::to_string(k));
}

}  // namespace tessera::test
