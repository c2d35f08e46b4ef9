// Areas, volumes and centroids of real parts are those of OpenCASCADE's BRepGProp.

#include "tessera/measures.h"

#include <gtest/gtest.h>
#include <opencascade/BRepGProp.hxx>
#include <opencascade/GProp_GProps.hxx>
#include <opencascade/TopExp_Explorer.hxx>
#include <opencascade/TopoDS.hxx>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "io_occt/cad_shapes.h"
#include "tessera/cad.h"

namespace tessera::test { namespace {

constexpr double exactness = 1e-9;  // that BRepGProp is asked for

struct PeerSolid {
  double volume;
  Vec3 centroid;
  bool is_taken = false;
};

std::vector<PeerSolid> solids_of(const TopoDS_Shape& shape) {
  std::vector<PeerSolid> all;
  for (TopExp_Explorer solid(shape, TopAbs_SOLID); solid.More(); solid.Next()) {
    GProp_GProps properties;
    BRepGProp::VolumeProperties(solid.Current(), properties, exactness);
    const gp_Pnt at = properties.CentreOfMass();
    all.push_back({std::abs(properties.Mass()), {at.X(), at.Y(), at.Z()}});
  }
  return all;
}

/// The largest differences, as shares.
struct Differences {
  std::size_t files = 0, solids = 0, faces = 0, decided = 0;
  double area = 0, volume = 0, centroid = 0;
  double ours = 0, theirs = 0;  ///< seconds
};

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// The area of patches by composite Gauss rules of 5 x 5 nodes in n x n cells, with the reference evaluator.
double reference_area(const PatchGrid& grid, int n) {
  constexpr double x[] = {0.04691007703066800, 0.2307653449471585, 0.5, 0.7692346550528415, 0.9530899229693320};
  constexpr double w[] = {0.1184634425280945, 0.2393143352496832, 0.2844444444444444, 0.2393143352496832,
                          0.1184634425280945};
  double sum = 0;
  for (const BezierPatch& patch : grid.patches())
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        for (int a = 0; a < 5; ++a)
          for (int b = 0; b < 5; ++b) {
            const SurfaceJet jet = evaluate_jet(patch, (i + x[a]) / n, (j + x[b]) / n);
            sum += w[a] * w[b] / (n * n) * length(cross(jet.du, jet.dv));
          }
  return sum;
}

/// Whether an area on which both differ is right. BRepGProp's rule stops early on splines: on faces without loops a
/// third quadrature decides; on others BRepGProp is taken to be right to 1e-5.
bool is_right(const ModelSurface& surface, const Measured& ours, double theirs) {
  if (!surface.trims->empty()) return std::abs(ours.value - theirs) <= ours.error + 1e-5 * theirs;
  const PatchGrid grid = value_of(to_bezier(surface));
  const double patches = static_cast<double>(grid.patches().size());
  const int n = std::max(4, static_cast<int>(32 / std::sqrt(patches)));
  const double fine = reference_area(grid, n), finer = reference_area(grid, 2 * n);
  return std::abs(ours.value - finer) <= ours.error + 4 * std::abs(finer - fine) &&
         std::abs(ours.value - finer) < 0.5 * std::abs(theirs - finer);
}

void compare_areas(const std::string& file, const TopoDS_Shape& shape, const Model& model, Differences& all) {
  double start = seconds();
  const AreaMeasures found = value_of(measure_surfaces(model));
  all.ours += seconds() - start;
  const std::vector<TopoDS_Face> faces = faces_of(shape);
  if (faces.size() != found.surfaces.size()) return;  // some cannot be read
  for (std::size_t k = 0; k < faces.size(); ++k) {
    GProp_GProps properties;
    start = seconds();
    BRepGProp::SurfaceProperties(faces[k], properties, exactness);
    all.theirs += seconds() - start;
    const double area = std::abs(properties.Mass());
    const Measured& ours = found.surfaces[k].area;
    ++all.faces;
    const double difference = std::abs(ours.value - area);
    if (difference <= ours.error + 1e-7 * area) {
      all.area = std::max(all.area, difference / area);
      continue;
    }
    ++all.decided;
    EXPECT_TRUE(is_right(model.surfaces[k], ours, area))
        << file << ": face " << k << ": " << ours.value << " +- " << ours.error << ", theirs " << area;
  }
}

/// Takes the solid of theirs that is most like a body; null if none is left.
const PeerSolid* take_nearest(std::vector<PeerSolid>& theirs, const BodyMeasures& body) {
  PeerSolid* nearest = nullptr;
  const double size = std::cbrt(body.volume.value);
  const auto distance = [&](const PeerSolid& solid) {
    return std::abs(std::cbrt(solid.volume) - size) + length(solid.centroid - body.centroid.value);
  };
  for (PeerSolid& solid : theirs)
    if (!solid.is_taken && (!nearest || distance(solid) < distance(*nearest))) nearest = &solid;
  if (nearest) nearest->is_taken = true;
  return nearest;
}

void compare_solids(const std::string& file, const TopoDS_Shape& shape, const Model& model, Differences& all) {
  double start = seconds();
  const Result<std::vector<BodyMeasures>> found = measure_solids(model);
  all.ours += seconds() - start;
  if (!found) {
    std::printf("%s: %s\n", file.c_str(), found.status().message().c_str());
    return;
  }
  start = seconds();
  std::vector<PeerSolid> theirs = solids_of(shape);
  all.theirs += seconds() - start;
  for (const BodyMeasures& body : *found) {
    const PeerSolid* const peer = take_nearest(theirs, body);
    if (!peer) continue;
    ++all.solids;
    const double size = std::cbrt(peer->volume), centroid = max_abs(peer->centroid - body.centroid.value);
    all.volume = std::max(all.volume, std::abs(peer->volume - body.volume.value) / peer->volume);
    all.centroid = std::max(all.centroid, centroid / size);
    EXPECT_NEAR(body.volume.value, peer->volume, body.volume.error + 1e-6 * peer->volume) << file;
    EXPECT_LE(centroid, body.centroid.error + 1e-6 * size) << file;
  }
}

void compare(const std::string& file, Differences& all) {
  const Result<DescribedShape> loaded = load_cad(file);
  const Result<Model> model = read_by_opencascade(file);
  if (!loaded || !model || model->surfaces.empty()) return;
  ++all.files;
  compare_areas(file, loaded->shape, *model, all);
  compare_solids(file, loaded->shape, *model, all);
}

TEST(Measures, OfRealFilesAreThoseOfOpenCascade) {
  const std::vector<std::filesystem::path> files = real_cad_files();
  if (files.empty()) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  Differences all;
  for (const std::filesystem::path& path : files) compare(path.string(), all);
  std::printf(
      "%zu files, %zu faces, %zu solids: largest difference of area %.2e (%zu faces decided by a third quadrature, or "
      "to 1e-5), volume %.2e, centroid %.2e; %.2f s, theirs %.2f s\n",
      all.files, all.faces, all.solids, all.area, all.decided, all.volume, all.centroid, all.ours, all.theirs);
  EXPECT_GT(all.solids, 0u);
  EXPECT_LE(20 * all.decided, all.faces);
}

}}  // namespace tessera::test
