// Closed meshes of CAD files beside those of OpenCASCADE's BRepMesh_IncrementalMesh at the same tolerance, each on one
// thread: solids, open edges, bound, gap, triangles and time. Each shape is meshed once, as both do.
//
// Shapes whose edges have single faces are joined first, as the command line does; the time has no part of that.
// Times: Tessera from the shape in memory (patches are made, loops prepared) to positions, normals and triangles;
// OpenCASCADE from the shape to positions and triangles, at its own angular deflection. Processor time, best of three.

#include <tbb/global_control.h>
#include <BRep_Tool.hxx>
#include <Poly_Triangulation.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io_occt/cad_shapes.h"
#include "occt/shape_model.h"
#include "peers/file_arguments.h"
#include "peers/interleaved.h"
#include "peers/joined_shape.h"
#include "peers/occt_shape.h"
#include "support/synthetic_sets.h"
#include "tessera/mesh.h"
#include "tessera/patch_set.h"
#include "tessera/tessellation.h"

namespace tessera::bench { namespace {

using test::value_of;

constexpr char usage[] =
    "tessera_peer_occt_closed_mesh [FILE...]\n\n"
    "Closed meshes of CAD files at ten tolerances beside OpenCASCADE's, one thread.\n"
    "Without files: all of the folder TESSERA_TEST_DATA. About 5 minutes.\n"
    "Exit status 1 if the mesh of a closed solid has an open edge.\n";

/// The meshes of a file's shapes.
struct Row {
  std::size_t open = 0, triangles = 0;
  double bound = 0, gap = 0;
};

Row mesh(const std::vector<Shape>& shapes, double tolerance, bool checks) {
  Row row;
  for (const Shape& shape : shapes) {
    const PatchSet set = value_of(make_patch_set(shape));
    const Tessellation plan = value_of(Tessellation::make(set, {.tolerance = tolerance}));
    Mesh made = value_of(plan.allocate());
    if (!plan.run(set, made.views()).ok()) std::abort();
    row.triangles += made.triangle_count();
    row.bound = std::max(row.bound, plan.bound());
    row.gap = std::max(row.gap, plan.gap());
    if (checks && is_closed(shape)) row.open += value_of(check(made)).open_edges;
  }
  return row;
}

/// The triangles of the faces of a shape, each face once.
std::size_t triangles_of(const TopoDS_Shape& shape) {
  std::size_t count = 0;
  std::set<const void*> seen;
  for (TopExp_Explorer at(shape, TopAbs_FACE); at.More(); at.Next()) {
    if (!seen.insert(at.Current().TShape().get()).second) continue;
    TopLoc_Location place;
    const Handle(Poly_Triangulation) found = BRep_Tool::Triangulation(TopoDS::Face(at.Current()), place);
    if (!found.IsNull()) count += static_cast<std::size_t>(found->NbTriangles());
  }
  return count;
}

/// Returns whether no closed solid has an open edge.
bool report(const std::filesystem::path& file) {
  const Result<DescribedShape> read = test::load_cad(file);
  const Result<OcctModel> made = read ? model_of(*read, file) : Result<OcctModel>(read.status());
  const Result<Model> model = made ? Result<Model>(made->model) : made.status();
  if (!model || model->shapes.empty()) {
    std::printf("%s: %s\n", file.filename().c_str(), model ? "no shapes" : model.status().message().c_str());
    return true;
  }
  std::vector<Shape> shapes;
  std::size_t faces = 0, closed = 0;
  Box3 box;
  for (const Shape& shape : model->shapes) {
    shapes.push_back(joined_shape(shape));
    faces += shape.faces.size();
    closed += is_closed(shapes.back());
    const PatchSet set = value_of(make_patch_set(shapes.back()));
    box.extend(set.box().lower), box.extend(set.box().upper);
  }
  const double size = box.diagonal();
  std::printf("%s: %zu faces, %zu of %zu shapes closed, size %.4g\n", file.filename().c_str(), faces, closed,
              shapes.size(), size);
  OcctShape theirs(read->shape, {});
  bool good = true;
  for (int k = 0; k < 10; ++k) {
    const double share = std::pow(10, -1 - k / 3.0), tolerance = share * size;
    const Row row = mesh(shapes, tolerance, true);
    good = good && row.open == 0;
    const auto ours = [&] { return seconds_of([&] { (void)mesh(shapes, tolerance, false); }); };
    const auto occt = [&] { return theirs.mesh(tolerance); };
    const std::vector<double> best = best_interleaved(3, {ours, occt}, 0.02);
    std::printf(
        "  %.1e: %zu open, bound %.2e, gap %.1e, %zu triangles, %.2f ms; OpenCASCADE %zu triangles, %.2f ms: %.1f "
        "times\n",
        share, row.open, row.bound / size, row.gap / size, row.triangles, 1e3 * best[0], triangles_of(read->shape),
        1e3 * best[1], best[1] / best[0]);
  }
  std::fflush(stdout);
  return good;
}

int run(std::vector<std::filesystem::path> files) {
  const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
  if (files.empty()) files = test::real_cad_files();
  if (files.empty()) throw std::runtime_error("name files, or set TESSERA_TEST_DATA");
  std::printf("Tolerances, bounds and gaps are shares of the size of the largest box of a shape.\n");
  bool good = true;
  for (const std::filesystem::path& file : files) {
    try {
      good = report(file) && good;
    } catch (const Standard_Failure& failure) {
      std::printf("%s: OpenCASCADE: %s\n", file.filename().c_str(), failure.GetMessageString());
    }
  }
  return good ? 0 : 1;
}

}}  // namespace tessera::bench

int main(int argc, char** argv) {
  try {
    return tessera::bench::run(tessera::bench::file_arguments(argc, argv, tessera::bench::usage));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "occt_closed_mesh: %s\n", error.what());
  }
  return 1;
}
