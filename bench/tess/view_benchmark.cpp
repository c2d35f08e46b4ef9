// Meshes that follow a camera: a new view in each frame, plan and vertices: view.plan+mesh. Beside it a new plan for
// each frame: view.anew. Both keep the same pixels, which each case checks for every frame.

#include <benchmark/benchmark.h>

#include <cmath>
#include <optional>
#include <string>

#include "suite.h"
#include "support/synthetic_sets.h"
#include "tessera/tessellation.h"
#include "timing.h"

namespace tessera::bench { namespace {

constexpr int rows = 50, columns = 50;
constexpr double pixels = 0.5, turn = 0.02;  // radians per frame

/// The view of a frame: a camera on a circle around the field.
View view_of(std::size_t frame) {
  const double angle = turn * static_cast<double>(frame);
  View view{.eye = {25 + 60 * std::cos(angle), 25 + 60 * std::sin(angle), 45}, .target = {25, 25, 0}};
  view.width = 1920, view.height = 1080;
  return view;
}

/// A mesh that is written anew where its topology changes, into memory that is kept.
struct Frames {
  PatchSet set = test::value_of(PatchSet::make(test::wavy_field(rows, columns)));
  TessellationOptions options{.pixels = PixelTolerance{pixels, view_of(0)}};
  Tessellation plan = test::value_of(Tessellation::make(set, options));
  Mesh mesh = test::value_of(plan.allocate());
  std::size_t frame = 0, triangles = 0, changes = 0;

  Frames() { (void)plan.run(set, mesh.views()); }
  Status write() {
    const MeshCapacity size = plan.capacity();
    triangles += size.triangles;
    mesh.positions.resize(3 * size.vertices), mesh.normals.resize(3 * size.vertices);
    mesh.parameters.resize(2 * size.vertices);
    mesh.indices.resize(3 * size.triangles), mesh.patches.resize(size.triangles);
    return plan.run(set, mesh.views());
  }
  Status check() const {
    return plan.pixels() <= pixels * (1 + 1e-6) ? Status() : Status(StatusCode::internal, "too many pixels");
  }
  Status follow() {
    if (Status status = plan.set_view(view_of(++frame)); !status.ok()) return status;
    const auto change = plan.update(set, mesh.views());
    if (!change) return change.status();
    changes += change->topology;
    const Status status = change->topology ? write() : Status();
    return status.ok() ? check() : status;
  }
  Status make_anew() {
    options.pixels->view = view_of(++frame);
    Result<Tessellation> made = Tessellation::make(set, options);
    if (!made) return made.status();
    plan = *std::move(made);
    const Status status = write();
    return status.ok() ? check() : status;
  }
};

void run(benchmark::State& state, bool anew) {
  Frames frames;
  const auto best = time_calls(state, 1, [&] { return anew ? frames.make_anew() : frames.follow(); });
  if (!best) return;
  const auto count = static_cast<double>(frames.frame);
  state.counters["triangles"] = static_cast<double>(frames.plan.capacity().triangles);
  state.counters["topologies"] = anew ? 1 : static_cast<double>(frames.changes) / count;
  state.counters["ns_a_patch"] = 1e9 * *best / (rows * columns);
}

const bool registered = [] {
  for (const bool anew : {false, true})
    add_case({anew ? "view.anew" : "view.plan+mesh", "bicubic2500", "3", "half_pixel"}, Part::quick,
             [anew](benchmark::State& state) { run(state, anew); });
  return true;
}();

}}  // namespace tessera::bench
