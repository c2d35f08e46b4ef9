// Points inside of real solids are those that OpenCASCADE's classifier finds inside.

#include <gtest/gtest.h>
#include <opencascade/BRepClass3d_SolidClassifier.hxx>
#include <opencascade/Standard_Failure.hxx>
#include <opencascade/TopExp_Explorer.hxx>
#include <opencascade/TopoDS.hxx>

#include <chrono>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "io_occt/cad_shapes.h"
#include "support/random_patches.h"
#include "tessera/cad.h"
#include "tessera/solid.h"

namespace tessera::test { namespace {

/// Counts of the points of all files.
struct SolidTally {
  std::size_t files = 0, open = 0, points = 0, certified = 0, inside = 0, near = 0, differ = 0;
  double ours = 0, theirs = 0;  ///< seconds
};

double clock_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Whether a point is in an odd number of solids, or -1 if the classifier says that it is on one, or fails.
class Classifiers {
 public:
  explicit Classifiers(const TopoDS_Shape& shape) {
    for (TopExp_Explorer solid(shape, TopAbs_SOLID); solid.More(); solid.Next())
      solids_.push_back(std::make_unique<BRepClass3d_SolidClassifier>(solid.Current()));
  }
  std::size_t size() const { return solids_.size(); }
  int is_inside(const Vec3& point) {
    bool inside = false;
    for (const auto& solid : solids_) {
      try {
        solid->Perform(gp_Pnt(point.x, point.y, point.z), 1e-7);
      } catch (const Standard_Failure&) {
        return -1;
      }
      if (solid->State() == TopAbs_ON || solid->State() == TopAbs_UNKNOWN) return -1;
      inside ^= solid->State() == TopAbs_IN;
    }
    return inside ? 1 : 0;
  }

 private:
  std::vector<std::unique_ptr<BRepClass3d_SolidClassifier>> solids_;
};

/// The side by rays in many directions, each a search of its own.
int side_by_vote(const RayScene& scene, const Vec3& point, Random& random) {
  int odd = 0, even = 0;
  for (int k = 0; k < 40; ++k) {
    const Ray ray{.origin = point, .direction = uniform_vector(random, -1, 1)};
    HitLists lists;
    if (!scene.all({&ray, 1}, lists).ok()) continue;
    ++(lists.hits.size() % 2 == 1 ? odd : even);
  }
  return odd > even ? 1 : 0;
}

void compare(const std::filesystem::path& path, SolidTally& all) {
  const Result<DescribedShape> loaded = load_cad(path.string());
  const Result<Model> model = read_by_opencascade(path.string());
  if (!loaded || !model || model->surfaces.empty()) return;
  Classifiers theirs(loaded->shape);
  if (theirs.size() == 0 || theirs.size() > 30) return;
  const Result<PatchSet> set = make_patch_set(*model);
  if (!set) return;
  const Result<RayScene> scene = RayScene::make(*set);
  const Result<PointScene> points = PointScene::make(*set);
  if (!scene || !points) return;
  const Result<Solid> solid = Solid::make(*scene);
  if (!solid) return;
  ++all.files;
  if (!solid->is_closed()) {
    ++all.open;
    return;
  }
  const Box3 box = scene->box();
  Random random(1);
  constexpr std::size_t count = 60;
  std::vector<Vec3> at;
  for (std::size_t k = 0; k < count; ++k) {
    const Vec3 share = uniform_vector(random, -0.52, 0.52), size = box.upper - box.lower;
    at.push_back(box.centre() + Vec3{share.x * size.x, share.y * size.y, share.z * size.z});
  }
  std::vector<Containment> found(count);
  double start = clock_seconds();
  ASSERT_TRUE(solid->contains(at, found).ok());
  all.ours += clock_seconds() - start;
  std::size_t differ = 0;
  for (std::size_t k = 0; k < count; ++k) {
    start = clock_seconds();
    const int inside = theirs.is_inside(at[k]);
    all.theirs += clock_seconds() - start;
    ++all.points, all.certified += found[k].certified, all.inside += found[k].side == PointSide::inside;
    if (inside < 0 || points->nearest(at[k]).distance < 1e-5 * box.diagonal()) {
      ++all.near;
      continue;
    }
    if ((found[k].side == PointSide::inside) == (inside == 1)) continue;
    const int vote = side_by_vote(*scene, at[k], random);
    ++differ;
    EXPECT_FALSE(found[k].certified && vote != (found[k].side == PointSide::inside ? 1 : 0))
        << path << ": " << at[k].x << " " << at[k].y << " " << at[k].z;
  }
  all.differ += differ;
  if (differ > 0) std::printf("%s: %zu of %zu differ\n", path.filename().c_str(), differ, count);
}

TEST(SolidPoints, OfRealFilesAreThoseOfOpenCascade) {
  const std::vector<std::filesystem::path> files = real_cad_files();
  if (files.empty()) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  SolidTally all;
  for (const std::filesystem::path& path : files) compare(path, all);
  std::printf(
      "%zu files, %zu of them open; %zu points, %zu certified, %zu inside, %zu too near to a face, %zu differ; %.3f s, "
      "theirs %.2f s\n",
      all.files, all.open, all.points, all.certified, all.inside, all.near, all.differ, all.ours, all.theirs);
  EXPECT_GT(all.inside, all.points / 20);
}

}}  // namespace tessera::test
