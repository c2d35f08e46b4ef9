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
  std::size_t files = 0, solids = 0, faces = 0, beyond = 0;
  double area = 0, volume = 0, centroid = 0;
  double ours = 0, theirs = 0;  ///< seconds
};

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

void compare_areas(const std::string& file, const TopoDS_Shape& shape, const Model& model, Differences& all) {
  double start = seconds();
  const Result<AreaMeasures> found = measure_surfaces(model);
  all.ours += seconds() - start;
  if (!found) {
    ADD_FAILURE() << file << ": " << found.status().message();
    return;
  }
  const std::vector<TopoDS_Face> faces = faces_of(shape);
  if (faces.size() != found->surfaces.size()) {
    std::printf("%s: %zu faces, theirs %zu\n", file.c_str(), found->surfaces.size(), faces.size());
    return;
  }
  for (std::size_t k = 0; k < faces.size(); ++k) {
    GProp_GProps properties;
    start = seconds();
    BRepGProp::SurfaceProperties(faces[k], properties, exactness);
    all.theirs += seconds() - start;
    const double area = std::abs(properties.Mass());
    const Measured& ours = found->surfaces[k].area;
    ++all.faces;
    const double difference = std::abs(ours.value - area);
    all.area = std::max(all.area, difference / found->total.area.value);
    if (difference <= ours.error + 1e-7 * area) continue;
    ++all.beyond;
    std::printf("%s: face %zu: area %.10g +- %.2g, theirs %.10g\n", file.c_str(), k, ours.value, ours.error, area);
  }
}

void compare(const std::string& file, Differences& all) {
  const Result<CadFile> loaded = load_cad(file);
  const Result<Model> model = read_cad(file);
  if (!loaded || !model || model->surfaces.empty()) return;
  ++all.files;
  compare_areas(file, loaded->shape, *model, all);
  double start = seconds();
  const Result<std::vector<BodyMeasures>> found = measure_solids(*model);
  all.ours += seconds() - start;
  if (!found) {
    std::printf("%s: %s\n", file.c_str(), found.status().message().c_str());
    return;
  }
  start = seconds();
  std::vector<PeerSolid> theirs = solids_of(loaded->shape);
  all.theirs += seconds() - start;
  for (const BodyMeasures& body : *found) {
    PeerSolid* nearest = nullptr;
    const double size = std::cbrt(body.volume.value);
    const auto distance = [&](const PeerSolid& solid) {
      return std::abs(std::cbrt(solid.volume) - size) + length(solid.centroid - body.centroid.value);
    };
    for (PeerSolid& solid : theirs)
      if (!solid.is_taken && (!nearest || distance(solid) < distance(*nearest))) nearest = &solid;
    if (!nearest) continue;
    nearest->is_taken = true;
    ++all.solids;
    const double volume = std::abs(nearest->volume - body.volume.value);
    const double centroid = max_abs(nearest->centroid - body.centroid.value);
    all.volume = std::max(all.volume, volume / nearest->volume);
    if (body.volume.error > 1e-6 * body.volume.value)
      std::printf("%s: solid: volume %.10g +- %.2g, gap %.2g theirs %.10g; LARGE\n", file.c_str(), body.volume.value,
                  body.volume.error, body.gap, nearest->volume);
    all.centroid = std::max(all.centroid, centroid / size);
    if (volume <= body.volume.error + 1e-7 * nearest->volume && centroid <= body.centroid.error + 1e-7 * size) continue;
    ++all.beyond;
    std::printf("%s: solid: volume %.10g +- %.2g, theirs %.10g; centroid off %.2g +- %.2g\n", file.c_str(),
                body.volume.value, body.volume.error, nearest->volume, centroid, body.centroid.error);
  }
}

TEST(Measures, OfRealFilesAreThoseOfOpenCascade) {
  const std::vector<std::filesystem::path> files = real_cad_files();
  if (files.empty()) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  Differences all;
  for (const std::filesystem::path& path : files) compare(path.string(), all);
  std::printf(
      "%zu files, %zu faces, %zu solids: largest difference of area %.2e, volume %.2e, centroid %.2e; "
      "%.2f s, theirs %.2f s; %zu beyond their bounds\n",
      all.files, all.faces, all.solids, all.area, all.volume, all.centroid, all.ours, all.theirs, all.beyond);
  EXPECT_EQ(all.beyond, 0u);
}

}}  // namespace tessera::test
