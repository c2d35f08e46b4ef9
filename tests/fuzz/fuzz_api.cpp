// libFuzzer: all calls of the library, with any numbers, must return in bounded time and memory, with a Status or with
// usable results. The input is read as a sequence of choices and numbers: a surface, a set of it, and calls with that
// set.

#include <fuzzer/FuzzedDataProvider.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <string_view>
#include <vector>

#include "tessera/evaluate.h"
#include "tessera/mesh.h"
#include "tessera/model.h"
#include "tessera/patch_set.h"
#include "tessera/tessellation.h"
#ifdef TESSERA_HAS_RAY
#include "tessera/ray_scene.h"
#endif

namespace {

using namespace tessera;

void require(bool holds) {
  if (!holds) std::abort();
}

/// Whether there is a value or an error with a message.
bool sound(const Status& status) {
  if (status.ok()) return true;
  require(!status.message().empty() && status.code() != StatusCode::internal &&
          status.code() != StatusCode::out_of_memory);
  return false;
}
template <class T>
bool sound(const Result<T>& result) {
  return result.ok() || sound(result.status());
}

class Program {
 public:
  explicit Program(FuzzedDataProvider& data) : data_(data) {}

  void run() {
    const Result<Surface> surface = make_surface();
    if (!sound(surface)) return;
    const Result<SurfaceJet> jet = evaluate_jet(*surface, number(), number());
    (void)sound(jet);
    const Result<PatchGrid> grid = to_bezier(*surface, {.tolerance = number(), .degree = small(), .max_patches = 16});
    if (!sound(grid)) return;
    PatchSetOptions options;
    options.blocks = {data_.ConsumeBool(), data_.ConsumeBool(), data_.ConsumeBool(), false, data_.ConsumeBool(), false};
    if (data_.ConsumeBool()) options.origin = point();
    Result<PatchSet> set = make_patch_set(std::span(&*grid, 1), options);
    if (!sound(set)) return;
    for (int calls = 0; calls < 6 && data_.remaining_bytes() > 0; ++calls) call(*set);
  }

 private:
  double number() {
    static constexpr double infinity = std::numeric_limits<double>::infinity();
    static constexpr double special[] = {
        0,     1,      -1,     0.5,  2,        1e-9,      1e30,
        1e300, 5e-324, 1e-300, 1e38, infinity, -infinity, std::numeric_limits<double>::quiet_NaN()};
    switch (data_.ConsumeIntegralInRange(0, 3)) {
      case 0:
        return special[data_.ConsumeIntegralInRange<std::size_t>(0, std::size(special) - 1)];
      case 1:
        return data_.ConsumeIntegralInRange(-8, 8) * 0.25;
      case 2:
        return data_.ConsumeFloatingPointInRange(-4.0, 4.0);
      default:
        return data_.ConsumeFloatingPoint<double>();
    }
  }
  Vec3 point() {
    const double x = number(), y = number(), z = number();
    return {x, y, z};
  }
  int small() { return data_.ConsumeIntegralInRange(-1, 17); }
  Domain domain() {
    if (data_.ConsumeBool()) return {};
    const double a = number(), b = number(), c = number(), d = number();
    return {a, b, c, d};
  }
  std::vector<Vec3> points(std::size_t count) {
    std::vector<Vec3> list(count + data_.ConsumeIntegralInRange<std::size_t>(0, 8) / 8);
    for (Vec3& p : list) p = point();
    return list;
  }
  std::vector<double> numbers(std::size_t count) {
    std::vector<double> list(count + data_.ConsumeIntegralInRange<std::size_t>(0, 8) / 8);
    for (double& x : list) x = number();
    return list;
  }
  template <class T>
  static Result<Surface> as_surface(const Result<T>& made) {
    return made ? Result<Surface>(Surface(*made)) : Result<Surface>(made.status());
  }

  Result<Surface> make_surface() {
    const int m = data_.ConsumeIntegralInRange(1, 4), n = data_.ConsumeIntegralInRange(1, 4);
    const std::size_t net = static_cast<std::size_t>((m + 1) * (n + 1));
    switch (data_.ConsumeIntegralInRange(0, 6)) {
      case 0:
        return as_surface(BezierPatch::polynomial(m, n, points(net)));
      case 1:
        return as_surface(BezierPatch::rational(m, n, points(net), numbers(net)));
      case 2: {
        const std::vector<double> u = numbers(static_cast<std::size_t>(2 * m + 3)),
                                  v = numbers(static_cast<std::size_t>(2 * n + 2));
        const std::vector<Vec3> list = points(static_cast<std::size_t>((m + 2) * (n + 1)));
        return as_surface(BSplineSurface::polynomial(m, u, n, v, std::span(list)));
      }
      case 3:
        return as_surface(HermitePatch::make(points(16), domain()));
      case 4:
        return as_surface(ExplicitPolynomial::make(m, n, numbers(net), domain()));
      case 5: {
        const std::vector<double> c = numbers(10);
        const Result<Quadric> made = Quadric::make({c[0], c[1], c[2], c[3], c[4], c[5], c[6], c[7], c[8], c[9]});
        if (!made) return made.status();
        return as_surface(QuadricPiece::make(*made, domain(), small()));
      }
      default: {
        const Result<Curve> a = Curve::bezier(points(static_cast<std::size_t>(m + 1))),
                            b = Curve::bezier(points(static_cast<std::size_t>(n + 1)));
        if (!a) return a.status();
        return b ? as_surface(RuledSurface::make(*a, *b)) : b.status();
      }
    }
  }

  void call(PatchSet& set) {
    switch (data_.ConsumeIntegralInRange(0, 4)) {
      case 0:
        return evaluate_grid(set);
      case 1:
        return evaluate_points(set);
      case 2:
        return tessellate(set);
      case 3:
        return cast(set);
      default:
        (void)sound(set.set_control_points(data_.ConsumeIntegralInRange<std::size_t>(0, 4),
                                           points(set.patch(0).points().size())));
    }
  }

  void evaluate_grid(const PatchSet& set) {
    const std::vector<double> u = numbers(3), v = numbers(2);
    const Result<GridPlan> plan = GridPlan::make(set, u, v, {.geometry = {number(), number()}});
    if (!sound(plan)) return;
    std::vector<float> memory(6 * plan->capacity()), curvature(plan->capacity());
    const QuantityViews<float> views{.position = View3<float>::interleaved(memory, 6, 0),
                                     .normal = View3<float>::interleaved(memory, 6, 3),
                                     .gaussian = View1<float>::interleaved(curvature)};
    if (!sound(evaluate(set, *plan, views))) return;
    for (const float x : memory) require(!std::isnan(x));
    for (const float x : curvature) require(!std::isnan(x));
  }

  void evaluate_points(const PatchSet& set) {
    const std::vector<std::uint32_t> patch{
        0, data_.ConsumeIntegral<std::uint32_t>() >> data_.ConsumeIntegralInRange(0, 31)};
    const std::vector<double> u{0.5, number()}, v{number(), 0.25};
    std::vector<float> fu(u.begin(), u.end()), fv(v.begin(), v.end()), memory(6);
    const PatchSamples<float> samples{View1<const std::uint32_t>::interleaved(patch),
                                      View1<const float>::interleaved(fu), View1<const float>::interleaved(fv)};
    const PointOptions options{.outside = data_.ConsumeBool() ? OutsideDomain::clamp : OutsideDomain::error};
    if (!sound(evaluate(set, samples, QuantityViews<float>{.position = View3<float>::interleaved(memory)}, options)))
      return;
    for (const float x : memory) require(!std::isnan(x));
  }

  void tessellate(PatchSet& set) {
    TessellationOptions options{.tolerance = number()};
    options.relative = data_.ConsumeBool();
    if (data_.ConsumeBool()) options.angle = number();
    options.joining.weld = number();
    options.joining.share_vertices = data_.ConsumeBool();
    if (data_.ConsumeBool()) options.tolerance.reset(), options.budget = 2000;
    options.fewest = data_.ConsumeBool();
    options.quads = data_.ConsumeBool();
    options.spare = data_.ConsumeBool() ? 0.25 : number();
    options.max_triangles = 2000;
    auto plan = Tessellation::make(set, options);
    if (!sound(plan)) return;
    Result<Mesh> mesh = plan->allocate();
    if (!sound(mesh) || !sound(plan->run(set, mesh->views()))) return;
    require_finite(*mesh);
    const std::vector<std::uint32_t> patch{data_.ConsumeIntegralInRange<std::uint32_t>(0, 4)};
    const Result<MeshChange> change = plan->update(set, {patch, points(set.patch(0).points().size())}, mesh->views());
    if (!sound(change)) return;
    if (change->topology) {
      mesh = plan->allocate();
      if (!sound(mesh) || !sound(plan->run(set, mesh->views()))) return;
    }
    require_finite(*mesh);
  }
  void require_finite(const Mesh& mesh) {
    const Result<MeshReport> report = check(mesh);
    require(report.ok() && report->non_finite_vertices == 0);
  }

#ifdef TESSERA_HAS_RAY
  void cast(const PatchSet& set) {
    RaySceneOptions options{
        .mode = data_.ConsumeBool() ? RayMode::grid : RayMode::exact, .rate = small(), .pieces = small()};
    if (data_.ConsumeBool()) options.tolerance = number();
    const auto scene = RayScene::make(set, options);
    if (!sound(scene)) return;
    for (int k = 0; k < 4; ++k) {
      const Ray ray{point(), point(), number(), number()};
      const Hit hit = scene->closest(ray);
      (void)scene->occluded(ray);
      if (hit.kind != HitKind::hit) continue;
      require(hit.t >= ray.tnear && hit.t <= ray.tfar && is_finite(hit.position) && !std::isnan(hit.normal.x));
    }
  }
#else
  void cast(const PatchSet&) {}
#endif

  FuzzedDataProvider& data_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* bytes, std::size_t size) {
  FuzzedDataProvider data(bytes, size);
  Program(data).run();
  return 0;
}
