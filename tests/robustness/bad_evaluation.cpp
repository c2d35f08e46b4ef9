// Grids and scattered points.

#include <vector>

#include "base/aligned.h"
#include "robustness/bad_input.h"
#include "robustness/bad_views.h"
#include "support/points.h"
#include "tessera/evaluate.h"

namespace tessera::test {
namespace {

using enum StatusCode;
using Numbers = std::vector<double>;

void grid_plans(Table& table, const PatchSet& set) {
  const Numbers t = uniform_parameters(3);
  table.of("uniform_parameters(count)");
  table.gives("count 1", "0 and 1", uniform_parameters(1) == Numbers{0, 1});
  table.gives("count -2147483648", "0 and 1", uniform_parameters(std::numeric_limits<int>::min()) == Numbers{0, 1});
  table.of("GridPlan::make(set, u, v, options)");
  table.row("no parameters", invalid_argument, GridPlan::make(set, Numbers{}, t));
  table.row("a parameter of NaN", non_finite, GridPlan::make(set, t, Numbers{0, not_a_number}));
  table.row("an infinite parameter", non_finite, GridPlan::make(set, Numbers{infinity}, t));
  table.row("a parameter of -0.001", invalid_argument, GridPlan::make(set, Numbers{-0.001}, t));
  table.row("a parameter of 1.001", invalid_argument, GridPlan::make(set, t, Numbers{0, 1, 1.001}));
  table.gives("a subnormal parameter", "accepted", GridPlan::make(set, Numbers{5e-324}, t).ok());
  table.row("precision that the set does not hold", unsupported,
            GridPlan::make(set, t, t, {.precision = Precision::double_precision}));
  table.row("a representation that the set does not hold", unsupported,
            GridPlan::make(set, t, t, {.representation = Representation::power}));
  table.row("an unknown precision", unsupported, GridPlan::make(set, t, t, {.precision = Precision{7}}));
  table.row("an unknown instruction set", isa_unavailable, GridPlan::make(set, t, t, {.isa = Isa{9}}));
  table.row("a smallest sine of -1e-9", invalid_argument, GridPlan::make(set, t, t, {.geometry = {.min_sine = -1e-9}}));
  table.row("an umbilic tolerance of NaN", invalid_argument,
            GridPlan::make(set, t, t, {.geometry = {.umbilic_tolerance = not_a_number}}));
  table.of("GridPlan::make(set, PatchParameters, options)");
  table.row("parameters that are not as many for each patch", invalid_argument,
            GridPlan::make(set, PatchParameters{.u = Numbers(7, 0.5), .v = Numbers(6, 0.5)}));
  table.row("no parameters", invalid_argument, GridPlan::make(set, PatchParameters{}));
  table.row("a parameter of NaN", non_finite,
            GridPlan::make(set, PatchParameters{.u = Numbers(6, not_a_number), .v = Numbers(6, 0.5)}));
}

void grid_views(Table& table, const PatchSet& set) {
  const Numbers t = uniform_parameters(3);
  const GridPlan plan = value_of(GridPlan::make(set, t, t));
  AllBuffers<float> memory(plan), clean(plan);
  const auto refused = [&](const std::string& input, StatusCode code, const QuantityViews<float>& views) {
    table.row(input, code, evaluate(set, plan, views), [&] { return memory == clean; });
  };
  table.of("evaluate(set, plan, QuantityViews, execution)");
  refused("no view", invalid_argument, {});
  bad_view(
      "positions", memory.views(), plan.capacity(), [](auto& views) -> auto& { return views.position; }, refused);
  bad_view(
      "directions", memory.views(), plan.capacity(), [](auto& views) -> auto& { return views.second_direction; },
      refused);
  QuantityViews<float> views = memory.views();
  views.gaussian.size = 0;
  refused("curvatures in a view of no records", buffer_too_small, views);
  views = memory.views();
  views.normal = views.position;
  refused("positions and normals in one place", invalid_argument, views);
  views = memory.views();
  for (float*& component : views.du.component) component = views.position.component[0] + 1;
  refused("derivatives that begin within positions", invalid_argument, views);

  AllBuffers<double> doubles(plan), clean_doubles(plan);
  table.row("a plan of the other precision", invalid_argument, evaluate(set, plan, doubles.views()),
            [&] { return doubles == clean_doubles; });
  const PatchSet other = set_of(wavy_field(1, 1));
  table.row("a plan for another set", stale, evaluate(other, plan, memory.views()), [&] { return memory == clean; });
  const std::atomic<bool> cancel = true;
  table.row("a cancellation before the first task", cancelled, evaluate(set, plan, memory.views(), {.cancel = &cancel}),
            [&] { return memory == clean; });
}

void grid_blocks(Table& table, const PatchSet& set) {
  const Numbers t = uniform_parameters(3);
  const GridPlan plan = value_of(GridPlan::make(set, t, t));
  AlignedVector<float> memory(2 * plan.block_capacity() + 1, -7.0f);
  const std::span<float> all = memory;
  const auto refused = [&](const std::string& input, StatusCode code, const QuantityBlocks<float>& blocks) {
    table.row(input, code, evaluate(set, plan, blocks),
              [&] { return std::ranges::all_of(memory, [](float x) { return x == -7.0f; }); });
  };
  const std::size_t capacity = plan.block_capacity();
  table.of("evaluate(set, plan, QuantityBlocks, execution)");
  refused("no memory", invalid_argument, {});
  refused("positions short by one number", buffer_too_small, {.position = all.first(capacity - 1)});
  refused("positions not aligned to 64 bytes", invalid_argument, {.position = all.subspan(1, capacity)});
  refused("positions and normals that overlap", invalid_argument,
          {.position = all.first(capacity), .normal = all.subspan(capacity - 16, capacity)});
}

/// Samples that are sound except for the change of each row.
class PointRows {
 public:
  PointRows(Table& table, const PatchSet& set) : table_(table), set_(set) {}

  void refused(const std::string& input, StatusCode code, const PatchSamples<float>& samples,
               const QuantityViews<float>& views, const PointOptions& options = {}) {
    table_.row(input, code, evaluate(set_, samples, views, options), [&] { return memory_ == clean_; });
  }
  template <class Change>
  void with_samples(const std::string& input, StatusCode code, Change change, const PointOptions& options = {}) {
    Samples<float> samples = sound_;
    change(samples);
    refused(input, code, samples.views(), memory_.views(), options);
  }
  template <class Change>
  void with_sample_views(const std::string& input, StatusCode code, Change change) {
    PatchSamples<float> views = sound_.views();
    change(views);
    refused(input, code, views, memory_.views());
  }
  QuantityViews<float> views() { return memory_.views(); }
  const Samples<float>& sound() const { return sound_; }

 private:
  static Samples<float> samples() {
    Samples<float> list;
    for (std::size_t k = 0; k < 5; ++k) list.add(k % 2, 0.25f, 0.5f);
    return list;
  }
  Table& table_;
  const PatchSet& set_;
  const Samples<float> sound_ = samples();
  AllBuffers<float> memory_{5}, clean_{5};
};

void samples_by_patch(Table& table, const PatchSet& set) {
  table.of("evaluate(set, PatchSamples, QuantityViews, options, execution)");
  PointRows rows(table, set);
  const float nan = static_cast<float>(not_a_number), inf = static_cast<float>(infinity);
  rows.with_samples("an unknown patch", invalid_argument, [](auto& s) { s.patch[3] = 2; });
  rows.with_samples("patch 4294967295", invalid_argument, [](auto& s) { s.patch[4] = 4294967295u; });
  rows.with_samples("u of -0.001", invalid_argument, [](auto& s) { s.u[2] = -0.001f; });
  rows.with_samples("v of 1e30", invalid_argument, [](auto& s) { s.v[1] = 1e30f; });
  for (const auto& [outside, name] : {std::pair{OutsideDomain::error, ""},
                                      {OutsideDomain::clamp, ", clamping"},
                                      {OutsideDomain::extrapolate, ", extrapolating"}}) {
    rows.with_samples(std::string("u of NaN") + name, non_finite, [&](auto& s) { s.u[2] = nan; }, {.outside = outside});
    rows.with_samples(std::string("v of infinity") + name, non_finite, [&](auto& s) { s.v[2] = inf; },
                      {.outside = outside});
  }
  rows.with_sample_views("fewer v than samples", count_mismatch, [](auto& views) { views.v.size = 3; });
  rows.with_sample_views("no u", count_mismatch, [](auto& views) { views.u = {}; });
  rows.with_sample_views("u with stride 0", invalid_argument, [](auto& views) { views.u.stride = 0; });
  rows.with_sample_views("u misaligned", invalid_argument, [](auto& views) { misalign(views.u); });
  const auto refused = [&](const std::string& input, StatusCode code, const QuantityViews<float>& views) {
    rows.refused(input, code, rows.sound().views(), views);
  };
  refused("no view", invalid_argument, {});
  bad_view(
      "positions", rows.views(), 5, [](auto& views) -> auto& { return views.position; }, refused);
  QuantityViews<float> same = rows.views();
  same.du = same.dv;
  refused("two derivatives in one place", invalid_argument, same);
  PatchSamples<float> over = rows.sound().views();
  over.u = {.component = {rows.views().position.component[0]}, .stride = 1, .size = 5};
  rows.refused("parameters in the place of an output", invalid_argument, over, rows.views());
  const auto sound = rows.sound().views();
  rows.refused("a smallest sine of 1", invalid_argument, sound, rows.views(), {.geometry = {.min_sine = 1}});
  rows.refused("an unknown instruction set", isa_unavailable, sound, rows.views(), {.isa = Isa{9}});
  table.gives("no samples", "nothing written", evaluate(set, PatchSamples<float>{}, rows.views()).ok());
  const std::vector<Vec3> corners{{0, 0, 0}, {0, 1e200, 0}, {1e200, 0, 0}, {1e200, 1e200, 0}};
  PatchSetOptions in_double;
  in_double.blocks = {.float_bernstein = false, .double_bernstein = true};
  const BezierPatch huge = value_of(BezierPatch::polynomial(1, 1, corners));
  const PatchSet far = value_of(PatchSet::make(std::vector{huge, huge}, in_double));
  table.row("a set in double, too far away for float", non_finite, evaluate(far, sound, rows.views()));
}

void samples_by_surface(Table& table, const PatchSet& set) {
  table.of("SurfaceMap::make(set)");
  std::vector<PatchSource> sources(2);  // both patches claim all of surface 0
  const std::vector<BezierPatch> patches = wavy_field(1, 2);
  PatchSetOptions with_sources = with_points();
  with_sources.sources = sources;
  const PatchSet torn = value_of(PatchSet::make(patches, with_sources));
  table.row("patches of a surface that are no grid", unsupported, SurfaceMap::make(torn));

  table.of("evaluate(set, map, SurfaceSamples, QuantityViews, options, execution)");
  const SurfaceMap map = value_of(SurfaceMap::make(set));
  AllBuffers<float> memory(2), clean(2);
  const std::vector<std::uint32_t> surfaces{0, 1}, wrong{0, 2};
  const auto refused = [&](const std::string& input, StatusCode code, const std::vector<std::uint32_t>& surface,
                           const Numbers& u, const Numbers& v) {
    const SurfaceSamples samples{View1<const std::uint32_t>::interleaved(surface), View1<const double>::interleaved(u),
                                 View1<const double>::interleaved(v)};
    table.row(input, code, evaluate(set, map, samples, memory.views()), [&] { return memory == clean; });
  };
  refused("an unknown surface", invalid_argument, wrong, {0.5, 0.5}, {0.5, 0.5});
  refused("u outside the surface's domain", invalid_argument, surfaces, {0.5, 7}, {0.5, 0.5});
  refused("v of NaN", non_finite, surfaces, {0.5, 0.5}, {not_a_number, 0.5});
  refused("v of 1e300", invalid_argument, surfaces, {0.5, 0.5}, {1e300, 0.5});
  refused("fewer v than u", count_mismatch, surfaces, {0.5, 0.5}, {0.5});
  refused("fewer surfaces than u", count_mismatch, {0}, {0.5, 0.5}, {0.5, 0.5});
  const PatchSet three = set_of(wavy_field(1, 3), with_points());
  const Numbers half{0.5, 0.5};
  const SurfaceSamples sound{{}, View1<const double>::interleaved(half), View1<const double>::interleaved(half)};
  table.row("a map of another set", stale, evaluate(three, map, sound, memory.views()),
            [&] { return memory == clean; });
}

}  // namespace

void fill_grids(Table& table) {
  const PatchSet set = set_of(wavy_field(1, 3));
  grid_plans(table, set);
  grid_views(table, set);
  grid_blocks(table, set);
}

void fill_points(Table& table) {
  const PatchSet set = set_of(wavy_field(1, 2), with_points());
  samples_by_patch(table, set);
  samples_by_surface(table, set);
}

}  // namespace tessera::test
