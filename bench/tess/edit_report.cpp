// Time to follow edits, over the time of a fresh set, plan and run, on one thread, in processor time. Both are
// measured in turns and write to memory that is there already; the shortest times count, and the sums.

#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <limits>
#include <string_view>
#include <vector>

#include "support/synthetic_sets.h"
#include "tessera/model.h"
#include "tessera/tessellation.h"

namespace {

using namespace tessera;
using test::value_of;

/// The cases to measure: those whose name contains this text.
std::string_view wanted;

double now() {
  timespec time;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

void need(const Status& status) {
  if (status.ok()) return;
  std::fprintf(stderr, "%s\n", status.message().c_str());
  std::exit(1);
}

/// Memory for meshes of any size.
struct Room {
  std::vector<float> positions, normals, parameters;
  std::vector<std::uint32_t> patches, indices;

  MeshViews views(const MeshCapacity& size) {
    const auto fit = [](auto& values, std::size_t count) {
      if (values.size() < count) values.resize(count + count / 2);
      return std::span(values).first(count);
    };
    MeshViews views;
    views.position = View3<float>::interleaved(fit(positions, 3 * size.vertices));
    views.normal = View3<float>::interleaved(fit(normals, 3 * size.vertices));
    views.parameter = View2<float>::interleaved(fit(parameters, 2 * size.vertices));
    views.patch = fit(patches, size.triangles);
    views.indices = fit(indices, 3 * size.triangles);
    return views;
  }
};

/// The shortest times, in seconds, and how often the topology changed.
struct Times {
  double fresh = std::numeric_limits<double>::infinity(), fresh_plan = fresh, update = fresh, sum_fresh = 0,
         sum_update = 0;
  int changes = 0, turns = 0;

  void print(const char* name, std::size_t triangles) const {
    std::printf("%-34s %8zu %9.1f %9.1f %9.1f %7.3f %9.4f %7.3f %4d/%d\n", name, triangles, 1e6 * fresh,
                1e6 * fresh_plan, 1e6 * update, update / fresh, update / fresh_plan, sum_update / sum_fresh, changes,
                turns);
  }
};

/// Measures one turn: `make` makes a fresh set, `follow` updates the plan.
template <class Make, class Follow>
void measure(Times& times, const TessellationOptions& options, PatchSet& set, Tessellation& plan, Room& room, Make make,
             Follow follow) {
  double start = now();
  const PatchSet fresh = make();
  const double made = now();
  const Tessellation anew = value_of(Tessellation::make(fresh, options));
  const double planned = now();
  const MeshViews views = room.views(anew.capacity());
  const double waited = now() - planned;
  need(anew.run(fresh, views));
  const double all = now() - start - waited;
  times.fresh = std::min(times.fresh, all);
  times.fresh_plan = std::min(times.fresh_plan, planned - made);
  need(plan.run(set, room.views(plan.capacity())));  // the mesh that is followed
  start = now();
  const MeshChange change = follow(room.views(plan.capacity()));
  if (change.topology) need(plan.run(set, room.views(plan.capacity())));
  const double update = now() - start;
  times.update = std::min(times.update, update);
  times.sum_fresh += all;
  times.sum_update += update;
  times.changes += change.topology;
  ++times.turns;
}

/// Edits of every step-th of rows x rows patches.
void patches(const char* name, int rows, std::size_t step, double tolerance, double by) {
  if (std::string_view(name).find(wanted) == std::string_view::npos) return;
  std::vector<BezierPatch> all = test::wavy_field(rows, rows);
  const TessellationOptions options{.tolerance = tolerance};
  PatchSet set = value_of(PatchSet::make(all));
  Tessellation plan = value_of(Tessellation::make(set, options));
  Room room;
  Times times;
  for (int turn = 0; turn < 40; ++turn) {
    std::vector<std::uint32_t> edited;
    std::vector<Vec3> points;
    for (std::size_t k = step / 2; k < all.size(); k += step) {
      edited.push_back(static_cast<std::uint32_t>(k));
      const std::size_t first = points.size();
      for (const Vec3& p : all[k].points()) points.push_back({p.x, p.y, p.z * (turn % 2 == 0 ? 1 + by : 1 / (1 + by))});
      all[k] = value_of(all[k].with_points(std::span(points).subspan(first)));
    }
    measure(
        times, options, set, plan, room, [&] { return value_of(PatchSet::make(all)); },
        [&](const MeshViews& views) {
          return value_of(plan.update(set, PatchEdits{edited, points}, views));
        });
  }
  times.print(name, plan.capacity().triangles);
}

/// A bicubic spline of count x count control points, of which all or one move each turn.
void spline(const char* name, std::size_t count, bool all, double tolerance, double by) {
  if (std::string_view(name).find(wanted) == std::string_view::npos) return;
  std::vector<double> knots(4, 0.0);
  for (std::size_t k = 1; k + 3 < count; ++k) knots.push_back(double(k));
  knots.insert(knots.end(), 4, double(count - 3));
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = 0; j < count; ++j) points.push_back({double(i), double(j), 0});
  const auto wave = [&](double time) {
    for (Vec3& p : points) p.z = std::sin(0.7 * p.x + by * time) * std::cos(0.6 * p.y - by * time);
  };
  wave(0);
  const auto made = [&] { return value_of(BSplineSurface::polynomial(3, knots, 3, knots, std::span(points))); };
  const BSplineSurface surface = made();
  const TessellationOptions options{.tolerance = tolerance};
  const PatchSetOptions at{.origin = Vec3{double(count) / 2, double(count) / 2, 0}};
  PatchSet set = value_of(make_patch_set(value_of(to_bezier(surface)), at));
  Tessellation plan = value_of(Tessellation::make(set, options));
  Room room;
  Times times;
  for (int turn = 1; turn <= 60; ++turn) {
    std::vector<std::uint32_t> moved;
    if (all) {
      wave(turn);
    } else {
      moved.push_back(static_cast<std::uint32_t>(count * count / 2 + count / 2));
      points[moved[0]].z += turn % 2 == 0 ? by : -by;
    }
    measure(
        times, options, set, plan, room, [&] { return value_of(make_patch_set(value_of(to_bezier(made())), at)); },
        [&](const MeshViews& views) {
          const SurfaceEdits edit{.spline = surface, .points = points, .moved = moved};
          return value_of(plan.update(set, std::span(&edit, 1), views));
        });
  }
  times.print(name, plan.capacity().triangles);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1) wanted = argv[1];
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  std::printf("%-34s %8s %9s %9s %9s %7s %9s %7s %s\n", "", "", "fresh us", "plan us", "update us", "/fresh", "/plan",
              "sums", "topology");
  for (const double tolerance : {0.1, 0.01, 0.001}) {
    std::printf("tolerance %g\n", tolerance);
    patches("all of 10,000 patches, a little", 100, 1, tolerance, 1e-4);
    patches("all of 10,000 patches, more", 100, 1, tolerance, 0.3);
    patches("1 in 20 of 10,000 patches", 100, 20, tolerance, 1e-4);
    patches("1 patch of 10,000, a little", 100, 10000, tolerance, 1e-4);
    patches("1 patch of 10,000, more", 100, 10000, tolerance, 2);
    spline("40 x 40 points, all, a little", 40, true, tolerance, 1e-4);
    spline("40 x 40 points, all", 40, true, tolerance, 0.1);
    spline("40 x 40 points, one", 40, false, tolerance, 1e-3);
    spline("103 x 103 points, one", 103, false, tolerance, 1e-3);
  }
}
