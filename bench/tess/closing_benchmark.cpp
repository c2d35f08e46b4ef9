// Meshes of shapes whose faces share edges, beside the same faces unconnected: plan and mesh, on one thread. Each mesh
// is checked after it was timed.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "suite.h"
#include "tessera/edge_matching.h"
#include "tessera/mesh.h"
#include "tessera/model.h"
#include "tessera/nurbs_surface.h"
#include "tessera/tessellation.h"
#include "timing.h"

namespace tessera::bench { namespace {

/// A wavy cubic spline of 8 x `faces` spans along u and v, cut into faces of 8 x 8 spans.
std::vector<ModelSurface> wavy_faces(int faces) {
  const int spans = 8 * faces;
  std::vector<double> knots(4, 0.0);
  for (int k = 1; k < spans; ++k) knots.push_back(k);
  knots.insert(knots.end(), 4, spans);
  std::vector<Vec3> points;
  for (int i = 0; i < spans + 3; ++i)
    for (int j = 0; j < spans + 3; ++j)
      points.push_back({double(i), double(j), 1.5 * std::sin(0.9 * i) * std::cos(0.7 * j)});
  std::vector<ModelSurface> all;
  for (int i = 0; i < faces; ++i)
    for (int j = 0; j < faces; ++j) {
      const Domain domain{8.0 * i, 8.0 * i + 8, 8.0 * j, 8.0 * j + 8};
      all.push_back({.name = {}, .surface = *BSplineSurface::polynomial(3, knots, 3, knots, points, domain)});
    }
  return all;
}

/// A plate with holes in a square: its top and bottom, the walls of the holes, and of the plate.
std::vector<ModelSurface> drilled_plate(int holes) {
  const double size = holes;
  const std::vector<double> knots{0, 0, size, size}, across{0, 0, 1, 1};
  const auto flat = [&](const Vec3& corner, const Vec3& a, const Vec3& b, std::vector<TrimLoop> trims) {
    const std::vector<Vec3> points{corner, corner + b, corner + a, corner + a + b};
    return ModelSurface{
        .name = {}, .surface = *BSplineSurface::polynomial(1, knots, 1, knots, points), .trims = std::move(trims)};
  };
  const Curve circle = *make_nurbs_circle({}, 0.3);
  const auto loop = [&](double x, double y) {
    std::vector<Vec3> points;
    for (const Vec3& p : circle.points()) points.push_back(p + Vec3{x, y, 0});
    return TrimLoop{{*Curve::nurbs(2, points, circle.weights(), circle.knots())}, true};
  };
  TrimLoop border;
  const Vec3 corners[] = {{0, 0, 0}, {size, 0, 0}, {size, size, 0}, {0, size, 0}};
  for (int k = 0; k < 4; ++k)
    border.curves.push_back(*Curve::bezier(std::vector<Vec3>{corners[k], corners[(k + 1) % 4]}));
  std::vector<TrimLoop> top{border}, bottom{border};
  std::vector<ModelSurface> all;
  for (int i = 0; i < holes; ++i)
    for (int j = 0; j < holes; ++j) {
      const double x = i + 0.5, y = j + 0.5;
      top.push_back(loop(x, y));
      bottom.push_back(loop(y, x));
      std::vector<Vec3> points;
      std::vector<double> weights;
      for (std::size_t k = 0; k < circle.points().size(); ++k)
        for (const double z : {1.0, 0.0}) {
          points.push_back(circle.points()[k] + Vec3{x, y, z});
          weights.push_back(circle.weight(k));
        }
      const std::vector<double> around(circle.knots().begin(), circle.knots().end());
      all.push_back({.name = {}, .surface = *BSplineSurface::rational(2, around, 1, across, points, weights)});
    }
  all.push_back(flat({0, 0, 1}, {size, 0, 0}, {0, size, 0}, top));
  all.push_back(flat({0, 0, 0}, {0, size, 0}, {size, 0, 0}, bottom));
  all.push_back(flat({0, 0, 0}, {size, 0, 0}, {0, 0, 1}, {}));
  all.push_back(flat({0, size, 0}, {0, 0, 1}, {size, 0, 0}, {}));
  all.push_back(flat({0, 0, 0}, {0, 0, 1}, {0, size, 0}, {}));
  all.push_back(flat({size, 0, 0}, {0, size, 0}, {0, 0, 1}, {}));
  return all;
}

/// The shortest of `count` times, in seconds.
template <class Task>
double best_of(int count, const Task& task) {
  double best = std::numeric_limits<double>::infinity();
  for (int k = 0; k < count; ++k) {
    const auto start = std::chrono::steady_clock::now();
    task();
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return best;
}

void close_edges(benchmark::State& state, const std::vector<ModelSurface>& faces, double tolerance, bool is_closed) {
  const Result<Shape> shape = joined_shape(faces, 1e-6);
  const Result<PatchSet> set = shape ? make_patch_set(*shape) : shape.status();
  if (!set) return state.SkipWithError(set.status().message().c_str());
  Mesh mesh;
  std::optional<Result<Tessellation>> plan;
  const auto make_with = [&](bool closes) -> Status {
    plan.emplace(Tessellation::make(*set, {.tolerance = tolerance, .joining = {.close_edges = closes}}));
    if (!*plan) return plan->status();
    mesh = *(*plan)->allocate();
    return (*plan)->run(*set, mesh.views());
  };
  // The unconnected faces first, a few times, then the timed ones.
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
  if (const Status status = make_with(false); !status.ok()) return state.SkipWithError(status.message().c_str());
  const double apart = best_of(counting() ? 1 : 5, [&] { (void)make_with(false); });
  const auto best = time_calls(state, 1, [&] { return make_with(true); });
  if (!best) return;
  const double run = best_of(counting() ? 1 : 20, [&] { (void)(*plan)->run(*set, mesh.views()); });
  const std::size_t open = (*plan)->open_edges();
  const Result<MeshReport> report = check(mesh);
  if (!report || report->open_edges != open || report->non_manifold_edges > 0 || (is_closed && open > 0))
    return state.SkipWithError("the mesh has other open edges than the shape");
  report_rates(state, *best, static_cast<double>(mesh.triangle_count()));
  state.counters["time_over_unconnected"] = *best / apart;
  state.counters["run_items_per_second"] = static_cast<double>(mesh.triangle_count()) / run;  // without the plan
}

const bool registered = [] {
  add_case({"closed.mesh", "wavy.faces64", "3", "0.02"}, Part::quick, [](benchmark::State& state) {
    const std::vector<ModelSurface> faces = wavy_faces(8);
    close_edges(state, faces, 0.02, false);
  });
  for (const auto& [holes, tolerance] : {std::pair{1, 1e-3}, {8, 1e-3}, {8, 1e-5}})
    add_case(
        {"closed.mesh", "plate" + square(static_cast<std::size_t>(holes)), "-", tolerance == 1e-3 ? "1e-3" : "1e-5"},
        Part::full,
        [=, h = holes, t = tolerance](benchmark::State& state) { close_edges(state, drilled_plate(h), t, true); });
  return true;
}();

}}  // namespace tessera::bench
