// Meshes of animated patches that keep a tolerance: control points in, positions, normals and new bounds of the touched
// patches out: update.mesh+bounds.SHARE. Each case checks what it timed against a new mesh. The limit is the time that
// the stores of the touched vertices take.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/aligned.h"
#include "suite.h"
#include "support/synthetic_sets.h"
#include "tess/tolerance_search.h"
#include "tessera/tessellation.h"
#include "timing.h"

namespace tessera::bench { namespace {

constexpr int rows = 100, columns = 100, rate = 8;

struct Case {
  std::size_t step;  ///< every step-th patch is touched
  int threads;

  CaseName name() const {
    const std::string share = step == 1 ? "all" : "one_in_" + std::to_string(step);
    return {"update.mesh+bounds." + share, "bicubic10000", "3", "rate" + std::to_string(rate), "-", threads};
  }
};

struct Vertices {
  AlignedVector<float> positions, normals;
  explicit Vertices(std::size_t count) : positions(3 * count), normals(3 * count) {}
  MeshViews views() {
    MeshViews out;
    out.position = View3<float>::interleaved(positions);
    out.normal = View3<float>::interleaved(normals);
    return out;
  }
};

/// Two shapes of the field, used alternately, as edits.
struct Animation {
  std::vector<std::uint32_t> patch;
  std::vector<Vec3> points[2];

  Animation(const Case& c, const std::vector<BezierPatch>& patches) {
    for (std::size_t k = 0; k < patches.size(); k += c.step) {
      patch.push_back(static_cast<std::uint32_t>(k));
      for (const Vec3& point : patches[k].points()) {
        points[0].push_back(point + Vec3{0, 0, 0.1 * point.x});
        points[1].push_back(point);
      }
    }
  }
  PatchEdits edits(std::size_t turn) const { return {patch, points[turn % 2]}; }
};

void run(benchmark::State& state, const Case& c) {
  const std::vector<BezierPatch> patches = test::wavy_field(rows, columns);
  PatchSet set = test::value_of(PatchSet::make(patches));
  Tessellation plan = plan_for(set, tolerance_for(set, rate));
  const MeshCapacity size = plan.capacity();
  Mesh mesh = test::value_of(plan.allocate());
  std::vector<std::uint8_t> is_touched(size.vertices, 0);
  if (const Status status = plan.run(set, mesh.views()); !status.ok())
    return state.SkipWithError(status.message().c_str());
  for (std::size_t k = 0; k < mesh.indices.size(); ++k) is_touched[mesh.indices[k]] = mesh.patches[k / 3] % c.step == 0;
  const auto touched = static_cast<double>(std::count(is_touched.begin(), is_touched.end(), 1));
  Vertices vertices(size.vertices);
  std::copy(mesh.positions.begin(), mesh.positions.end(), vertices.positions.begin());
  std::copy(mesh.normals.begin(), mesh.normals.end(), vertices.normals.begin());
  const Animation animation(c, patches);
  const Work work{.bytes_written = 6 * sizeof(float) * touched};
  const LimitsAround around({}, work.bytes_written);
  std::size_t turn = 0;
  const auto best = time_calls(state, c.threads, [&] {
    const auto change = plan.update(set, animation.edits(turn++), vertices.views());
    return change && change->topology ? Status(StatusCode::internal, "the topology has changed") : change.status();
  });
  const auto limits = around.best(state);
  if (!best || !limits) return;
  if (!plan.run(set, mesh.views()).ok() ||
      !std::equal(mesh.positions.begin(), mesh.positions.end(), vertices.positions.begin()) ||
      !std::equal(mesh.normals.begin(), mesh.normals.end(), vertices.normals.begin()))
    return state.SkipWithError("the timed values differ from a new mesh's");
  report_rates(state, *best, touched, work.bytes_written);
  state.counters["ns_a_patch"] = 1e9 * *best / static_cast<double>(animation.patch.size());
  if (c.threads == 1) report_limit(state, *best, *limits, work);
}

void add(const Case& c) {
  add_case(c.name(), c.step == 1 && c.threads == 1 ? Part::quick : Part::full,
           [c](benchmark::State& state) { run(state, c); });
}

const bool registered = [] {
  for (const std::size_t step : {1, 2, 20, 500, rows * columns}) add({step, 1});
  add({1, 2});
  return true;
}();

}}  // namespace tessera::bench
