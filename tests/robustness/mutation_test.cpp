// Random mutations of valid surfaces, rays and options: nothing crashes, and no result is NaN without a flag.
// TESSERA_MUTATIONS sets their number, 100,000 for a proof; the default takes a few seconds.

#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <string>

#include "robustness/mutated_surfaces.h"
#include "support/grids.h"
#include "tessera/evaluate.h"
#include "tessera/tessellation.h"
#ifdef TESSERA_HAS_RAY
#include "tessera/ray_scene.h"
#endif

namespace tessera::test { namespace {

/// One mutation, from a surface to its mesh and its hits.
class Case {
 public:
  explicit Case(std::uint64_t seed) : m_(seed) {}

  /// Returns how far the case came.
  const char* run() {
    const Result<Surface> surface = mutated_surface(m_);
    if (!sound(surface)) return "surface refused";
    const ModelSurface placed{"m", *surface, m_.chance(0.2) ? placement() : Affine{}};
    look_at(placed);
    const Result<PatchGrid> grid = to_bezier(placed, fit());
    if (!sound(grid)) return "conversion refused";
    Result<PatchSet> set = make_patch_set(std::span(&*grid, 1), options());
    if (!sound(set)) return "set refused";
    evaluate_all(*set);
    evaluate_points(*set);
    tessellate(*set);
    cast(*set);
    edit(*set);
    return "all done";
  }

 private:
  /// Whether there is a value or an error with a message.
  template <class T>
  static bool sound(const Result<T>& result) {
    if (!result) sound(result.status());
    return result.ok();
  }
  static bool sound(const Status& status) {
    if (status.ok()) return true;
    EXPECT_FALSE(status.message().empty());
    EXPECT_NE(status.code(), StatusCode::internal) << status.message();
    EXPECT_NE(status.code(), StatusCode::out_of_memory) << status.message();
    return false;
  }
  template <class T>
  static void expect_numbers(const std::vector<T>& values, const char* what) {
    for (const T x : values)
      if (std::isnan(x)) return (void)(ADD_FAILURE() << "NaN in " << what);
  }

  Affine placement() {
    Affine map = Affine::rotated({1, 2, 3}, m_.number(0.7));
    for (Vec3& column : map.columns) column = m_.point(column);
    map.translation = m_.point({10, 0, 0});
    return map;
  }
  FitOptions fit() {
    return {.tolerance = m_.number(0.01), .degree = m_.integer(3), .max_patches = 64, .certify = m_.chance(0.5)};
  }
  PatchSetOptions options() {
    PatchSetOptions made;
    made.blocks = {!m_.chance(0.05), m_.chance(0.3), m_.chance(0.1), m_.chance(0.1), m_.chance(0.5), m_.chance(0.1)};
    if (m_.chance(0.2)) made.origin = m_.point({1, 0, 0});
    return made;
  }

  void look_at(const ModelSurface& surface) {
    const Domain d = domain(surface.surface);
    const Result<SurfaceJet> jet = evaluate_jet(surface, m_.number(d.u_at(0.3)), m_.number(d.v_at(0.6)));
    if (!sound(jet)) return;
    EXPECT_FALSE(std::isnan(jet->position.x)) << kind_name(surface.surface);
  }

  template <class T>
  void evaluate_grid(const PatchSet& set) {
    const std::vector<double> u = m_.list(std::vector<double>{0, 0.25, 1}), v = m_.list(std::vector<double>{0, 0.6, 1});
    GridPlanOptions how;
    how.precision = precision_of<T>;
    how.representation = m_.chance(0.1) ? Representation::power : Representation::bernstein;
    how.geometry = {m_.number(1e-10), m_.number(1e-9)};
    const Result<GridPlan> plan = GridPlan::make(set, u, v, how);
    if (!sound(plan)) return;
    AllBuffers<T> out(*plan);
    if (!sound(evaluate(set, *plan, out.views()))) return;
    std::size_t k = 0;
    for_each_value_quantity([&](const auto& output) { expect_numbers(out.values[k++], output.name); });
  }
  void evaluate_all(const PatchSet& set) {
    evaluate_grid<float>(set);
    evaluate_grid<double>(set);
  }
  void evaluate_points(const PatchSet& set) {
    if (!set.blocks().float_points) return;
    std::vector<std::uint32_t> patch;
    std::vector<float> u, v;
    for (int k = 0; k < 8; ++k) {
      patch.push_back(static_cast<std::uint32_t>(m_.integer(static_cast<int>(m_.below(set.patch_count())))));
      u.push_back(static_cast<float>(m_.number(uniform(m_.random(), 0, 1))));
      v.push_back(static_cast<float>(m_.number(uniform(m_.random(), 0, 1))));
    }
    AllBuffers<float> out(patch.size());
    const PointOptions how{.outside = m_.chance(0.5) ? OutsideDomain::clamp : OutsideDomain::error,
                           .geometry = {m_.number(1e-10), m_.number(1e-9)}};
    const PatchSamples<float> samples{View1<const std::uint32_t>::interleaved(patch),
                                      View1<const float>::interleaved(u), View1<const float>::interleaved(v)};
    if (!sound(evaluate(set, samples, out.views(), how))) return;
    std::size_t k = 0;
    for_each_value_quantity([&](const auto& output) { expect_numbers(out.values[k++], output.name); });
  }

  void write(const PatchSet& set, const Result<Tessellation>& plan) {
    if (!sound(plan)) return;
    Result<Mesh> mesh = plan->allocate();
    if (!sound(mesh) || !sound(plan->run(set, mesh->views()))) return;
    expect_numbers(mesh->positions, "a mesh's positions");
    expect_numbers(mesh->normals, "a mesh's normals");
    const Result<MeshReport> report = check(*mesh);
    if (!sound(report)) return;
    EXPECT_EQ(report->vertices, mesh->vertex_count());
  }
  void tessellate(const PatchSet& set) {
    const int rate = m_.integer(2);
    if (rate <= 16) write(set, Tessellation::make(set, {.rates = UniformRates{rate, m_.chance(0.5) ? 1 : rate}}));
    const double size = set.box().diagonal();
    TessellationOptions how{.tolerance = m_.number(0.05 * size),
                            .joining = {.weld = m_.number(m_.chance(0.5) ? 0.0 : 1e-6 * size)}};
    how.max_triangles = 5000;
    if (m_.chance(0.2)) how.angle = m_.number(0.5);
    if (m_.chance(0.1)) how.tolerance.reset(), how.budget = how.max_triangles;
    how.fewest = m_.chance(0.1);
    if (m_.chance(0.1))
      how.pixels = PixelTolerance{m_.number(2), {.eye = m_.point({3, 4, 5}), .target = m_.point({0, 0, 0})}};
    how.joining.share_vertices = m_.chance(0.2);
    if (m_.chance(0.2)) how.joining.crease_angle = m_.number(0.1);
    how.relative = m_.chance(0.1);
    how.quads = m_.chance(0.2);
    write(set, Tessellation::make(set, how));
  }

#ifdef TESSERA_HAS_RAY
  void expect_sound(const Hit& hit, const Ray& ray) {
    if (hit.kind != HitKind::hit) return;
    EXPECT_TRUE(hit.t >= ray.tnear && hit.t <= ray.tfar) << hit.t;
    for (const double x :
         {hit.u, hit.v, hit.patch_u, hit.patch_v, hit.residual, hit.normal.x, hit.normal.y, hit.normal.z})
      EXPECT_FALSE(std::isnan(x));
    EXPECT_TRUE(is_finite(hit.position));
  }
  void cast(const PatchSet& set) {
    if (!m_.chance(0.5)) return;
    RaySceneOptions how{.mode = m_.chance(0.3) ? RayMode::grid : RayMode::exact};
    const int rate = m_.integer(4);
    how.rate = rate <= 16 || rate > 4096 ? rate : 4;
    how.pieces = m_.integer(1);
    if (m_.chance(0.3)) how.tolerance = m_.number(1e-6);
    const Result<RayScene> scene = RayScene::make(set, how);
    if (!sound(scene)) return;
    std::vector<Ray> rays;
    const Vec3 centre = set.box().centre();
    const double size = set.box().diagonal();
    for (int k = 0; k < 12; ++k) {
      const Vec3 origin = centre + size * uniform_vector(m_.random(), -1, 1);
      const Vec3 target = centre + 0.3 * size * uniform_vector(m_.random(), -1, 1);
      rays.push_back(
          {m_.point(origin), m_.point(target - origin), m_.number(0), m_.number(std::numeric_limits<double>::max())});
    }
    std::vector<Hit> hits(rays.size());
    std::vector<std::uint8_t> dark(rays.size());
    if (!sound(scene->closest(rays, hits)) || !sound(scene->occluded(rays, dark))) return;
    for (std::size_t k = 0; k < rays.size(); ++k) expect_sound(hits[k], rays[k]);
    HitLists lists;
    if (how.mode == RayMode::grid || !sound(scene->all(rays, lists))) return;
    for (std::size_t k = 0; k < rays.size(); ++k)
      for (std::size_t i = lists.first[k]; i < lists.first[k + 1]; ++i) expect_sound(lists.hits[i], rays[k]);
  }
#else
  void cast(const PatchSet&) {}
#endif

  void edit(PatchSet& set) {
    const std::size_t patch = m_.below(set.patch_count());
    const auto points = set.patch(patch).points();
    if (sound(set.set_control_points(patch, m_.list(std::vector(points.begin(), points.end())))))
      evaluate_grid<float>(set);
  }

  Mutator m_;
};

TEST(Mutations, NothingCrashesAndNothingIsNaN) {
  const char* const wanted = std::getenv("TESSERA_MUTATIONS");
  const std::uint64_t count = wanted ? std::strtoull(wanted, nullptr, 10) : 2000;
  const char* const from = std::getenv("TESSERA_FIRST_MUTATION");
  const std::uint64_t first = from ? std::strtoull(from, nullptr, 10) : 0;
  std::map<std::string, std::size_t> ends;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    SCOPED_TRACE("mutation " + std::to_string(seed));
    ++ends[Case(seed).run()];
    if (HasFailure() && !wanted) break;
  }
  for (const auto& [end, cases] : ends) std::printf("%s: %zu\n", end.c_str(), cases);
  EXPECT_GT(ends["all done"], count / 5);
}

}}  // namespace tessera::test
