// Grids of many patches: evaluate.OUTPUTS.LAYOUT, with ".double" for doubles, ".streamed" or ".plain" if stores are or
// are not non-temporal at any size, and ".cold" if the caches hold other memory before each call. Each case checks the
// values that it timed against the reference evaluator before it reports. The limit is GridPlan::work().

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <type_traits>

#include "base/aligned.h"
#include "eval/quantity_table.h"
#include "sets.h"
#include "suite.h"
#include "tessera/evaluate.h"
#include "timing.h"

namespace tessera::bench { namespace {

/// `vertices`: records of 32 bytes, position, normal and two floats of the caller's, such as uv.
enum class Layout { blocks, interleaved, vertices };

struct Case {
  std::string set_name;
  int size;  ///< parameters per direction
  QuantityFlags outputs;
  Layout layout;
  Isa isa;
  int threads = 1;
  Stores stores = Stores::automatic;
  bool cold = false, twice = false;

  CaseName name() const {
    const bool rational = set_name.starts_with("rational");
    return {"evaluate." + outputs_name() +
                (layout == Layout::blocks     ? ".blocks"
                 : layout == Layout::vertices ? ".vertices"
                                              : ".interleaved") +
                (twice ? ".double" : "") +
                (stores == Stores::streaming ? ".streamed"
                 : stores == Stores::plain   ? ".plain"
                                             : "") +
                (cold ? ".cold" : ""),
            set_name,
            rational ? "3r" : "3",
            square(static_cast<std::size_t>(size)),
            std::string(tessera::name(isa)),
            threads};
  }
  std::string outputs_name() const {
    if (outputs.first_form) return "geometry";  // normals, forms, curvatures, directions, kinds
    if (outputs.gaussian) return "curvatures";  // positions, first and second derivatives, K, H
    return outputs.du ? "positions+du+dv" : outputs.normal ? "positions+normals" : "positions";
  }
};

/// Memory for every output of one case, in either layout.
template <class T>
class Outputs {
 public:
  Outputs(const GridPlan& plan, const Case& c) : layout_(c.layout) {
    const std::size_t records = layout_ == Layout::blocks ? plan.block_capacity() / 3 : plan.capacity();
    const auto make_room = [&](const auto& output, auto& memory) {
      if (output.of(c.outputs)) memory.assign(records * static_cast<std::size_t>(output.width), {});
    };
    std::size_t k = 0;
    for_each_value_quantity([&](const auto& output) {
      auto& memory = values_[k++];
      make_room(output, memory);
      output.of(blocks_) = memory;
      if (!memory.empty()) output.of(views_) = std::remove_cvref_t<decltype(output.of(views_))>::interleaved(memory);
    });
    join_normals(records);
    if (c.outputs.normal_kind) normal_kinds_.assign(records, {});
    if (c.outputs.curvature_kind) curvature_kinds_.assign(records, {});
    blocks_.normal_kind = normal_kinds_;
    blocks_.curvature_kind = curvature_kinds_;
    if (!normal_kinds_.empty()) views_.normal_kind = View1<NormalKind>::interleaved(normal_kinds_);
    if (!curvature_kinds_.empty()) views_.curvature_kind = View1<CurvatureKind>::interleaved(curvature_kinds_);
  }
  Outputs(const Outputs&) = delete;
  Outputs& operator=(const Outputs&) = delete;

  Status evaluate(const PatchSet& set, const GridPlan& plan, const Execution& execution) {
    return layout_ == Layout::blocks ? tessera::evaluate(set, plan, blocks_, execution)
                                     : tessera::evaluate(set, plan, views_, execution);
  }

  /// Whether the caller's floats beside positions and normals are what they were.
  bool keeps_gaps() const {
    for (std::size_t k = 6; layout_ == Layout::vertices && k + 1 < values_[0].size(); k += 8)
      if (values_[0][k] != T(7) || values_[0][k + 1] != T(7)) return false;
    return true;
  }

  /// One output at one sample; nothing if the output is not requested.
  template <class Output>
  bool read(const PatchSet& set, const GridPlan& plan, const Output& output, std::size_t patch, std::size_t sample,
            Vec3& value) const {
    const auto memory = output.of(blocks_);
    if (memory.empty()) return false;
    const std::size_t samples = plan.count_u() * plan.count_v(), width = static_cast<std::size_t>(output.width);
    const PatchSet::Slot slot = set.slot(patch);
    const std::size_t place = (slot.block * samples + sample) * width * PatchSet::lanes + slot.lane;
    const auto component = [&](int c) -> double {
      if (layout_ != Layout::blocks) return output.of(views_).at(patch * samples + sample, c);
      return memory[place + static_cast<std::size_t>(c) * PatchSet::lanes];
    };
    value = width == 1 ? Vec3{component(0), 0, 0} : Vec3{component(0), component(1), component(2)};
    return true;
  }

 private:
  /// Lets positions and normals share records of six, or of eight, if there are no other outputs.
  void join_normals(std::size_t records) {
    if (views_.normal.empty() || views_.position.empty()) return;
    const std::size_t width = layout_ == Layout::vertices ? 8 : 6;
    values_[0].assign(width * records, T(7));
    blocks_.position = values_[0];
    views_.position = View3<T>::interleaved(values_[0], width, 0);
    views_.normal = View3<T>::interleaved(values_[0], width, 3);
  }

  Layout layout_;
  std::array<AlignedVector<T>, value_quantities> values_;
  AlignedVector<NormalKind> normal_kinds_;
  AlignedVector<CurvatureKind> curvature_kinds_;
  QuantityBlocks<T> blocks_;
  QuantityViews<T> views_;
};

/// The expected value of an output, and its tolerance where it is well conditioned: far looser than the tests, and far
/// tighter than a wrong answer. `size` is that of the set.
struct Expected {
  Vec3 value;
  double tolerance;
};
Expected expected_value(const std::string& name, const Vec3& origin, const SurfaceJet& jet, const LocalGeometry& g,
                        double size) {
  const double bend = std::abs(g.first.curvature) + std::abs(g.second.curvature) + 1 / size;
  if (name == "position") return {jet.position - origin, 1e-5 * size};
  if (name == "du") return {jet.du, 1e-5 * size};
  if (name == "dv") return {jet.dv, 1e-5 * size};
  if (name == "duu") return {jet.duu, 1e-4 * size};
  if (name == "duv") return {jet.duv, 1e-4 * size};
  if (name == "dvv") return {jet.dvv, 1e-4 * size};
  if (name == "normal") return {g.normal.direction, 1e-3};
  if (name == "first_form") return {{g.e, g.f, g.g}, 1e-4 * size * std::sqrt(std::max(g.e, g.g))};
  if (name == "second_form") return {{g.l, g.m, g.n}, 1e-3 * size};
  if (name == "gaussian") return {{g.gaussian, 0, 0}, 0.01 * bend * bend};
  if (name == "mean") return {{g.mean, 0, 0}, 0.01 * bend};
  if (name == "first_curvature") return {{g.first.curvature, 0, 0}, 0.01 * bend};
  if (name == "second_curvature") return {{g.second.curvature, 0, 0}, 0.01 * bend};
  // Directions are known up to their sign; unit tests check the curvatures along them.
  return {{}, 1.001};
}

/// Checks every sample of 50 patches against the reference evaluators.
template <class T>
bool check_values(const PatchSet& set, const GridPlan& plan, const std::vector<double>& t, const Outputs<T>& out) {
  const Vec3 origin = sizeof(T) == 4 ? set.origin() : Vec3{};
  const double size = set.box().diagonal();
  const std::size_t step = std::max<std::size_t>(1, set.patch_count() / 50);
  bool right = true;
  for (std::size_t patch = 0; patch < set.patch_count(); patch += step) {
    for (std::size_t sample = 0; sample < t.size() * t.size(); ++sample) {
      const double u = t[sample / t.size()], v = t[sample % t.size()];
      const SurfaceJet jet = evaluate_jet(set.patch(patch), u, v);
      const LocalGeometry geometry = local_geometry(set.patch(patch), u, v);
      const bool conditioned =
          geometry.defined && length(cross(jet.du, jet.dv)) > 1e-3 * std::max(geometry.e, geometry.g) &&
          std::min(geometry.e, geometry.g) > 1e-6 * size * size / static_cast<double>(set.patch_count());
      for_each_value_quantity([&](const auto& output) {
        const Expected expected = expected_value(output.name, origin, jet, geometry, size);
        Vec3 value;
        const bool needs_normal = output.order == 2 ? output.name[0] != 'd' : std::string(output.name) == "normal";
        if (!out.read(set, plan, output, patch, sample, value) || (needs_normal && !conditioned)) return;
        right = right && max_abs(value - expected.value) <= expected.tolerance;
      });
    }
  }
  return right;
}

/// Fills the caches with other memory.
void cool() {
  static AlignedVector<std::byte> other(std::size_t{96} << 20);
  for (std::size_t k = 0; k < other.size(); k += cache_line) other[k] = std::byte(std::to_integer<int>(other[k]) + 1);
}

template <class T>
void run(benchmark::State& state, const Case& c) {
  const PatchSet& set = set_named(c.set_name);
  const std::vector<double> t = uniform_parameters(c.size);
  auto plan = GridPlan::make(
      set, t, t, {.precision = c.twice ? Precision::double_precision : Precision::single_precision, .isa = c.isa});
  if (!plan) return state.SkipWithError(plan.status().message().c_str());
  Outputs<T> out(*plan, c);
  const Work work = plan->work(c.outputs);
  const LimitsAround around(c.isa, work.bytes_written);
  ExecutionReport report;
  Execution execution;
  execution.report = &report;
  execution.stores = c.stores;
  const auto call = [&] { return out.evaluate(set, *plan, execution); };
  const auto best = c.cold ? time_calls(state, c.threads, call, [] { cool(); }) : time_calls(state, c.threads, call);
  const auto limits = around.best(state);
  if (!best || !limits) return;
  if (report.isa != c.isa) return state.SkipWithError("another instruction set ran than was asked for");
  if (!check_values(set, *plan, t, out) || !out.keeps_gaps())
    return state.SkipWithError("the timed values differ from the reference");
  report_rates(state, *best, static_cast<double>(plan->capacity()), work.bytes_written);
  if (c.threads == 1) report_limit(state, *best, *limits, work);
}

/// Only the full set has sets of patches that take seconds to build.
bool is_quick(const Case& c) {
  const bool small = c.set_name == "teapot" || c.set_name == "bicubic1000";
  return c.size == 9 && c.layout != Layout::vertices &&
         (small || (c.set_name == "bicubic20000" && c.stores == Stores::automatic && !c.twice));
}

void add(const Case& c) {
  add_case(c.name(), is_quick(c) ? quick_on_fastest(c.isa) : Part::full,
           [c](benchmark::State& state) { c.twice ? run<double>(state, c) : run<float>(state, c); });
}

/// The smallest set whose results are far larger than the caches: 150 MB.
std::string large_set(int size, const QuantityFlags& outputs, std::size_t value = sizeof(float)) {
  std::size_t bytes = 0;
  for_each_value_quantity([&](const auto& output) {
    if (output.of(outputs)) bytes += static_cast<std::size_t>(output.width * size * size) * value;
  });
  for (const int patches : {20000, 50000, 100000, 200000, 500000})
    if (bytes * static_cast<std::size_t>(patches) >= 150'000'000) return "bicubic" + std::to_string(patches);
  return "bicubic1000000";
}

const bool registered = [] {
  const QuantityFlags positions{.position = true}, normals{.position = true, .normal = true},
      tangents{.position = true, .du = true, .dv = true};
  const QuantityFlags curvatures{
      .position = true, .du = true, .dv = true, .duu = true, .duv = true, .dvv = true, .gaussian = true, .mean = true};
  const QuantityFlags geometry{.normal = true,
                               .first_form = true,
                               .second_form = true,
                               .gaussian = true,
                               .mean = true,
                               .first_curvature = true,
                               .second_curvature = true,
                               .first_direction = true,
                               .second_direction = true,
                               .normal_kind = true,
                               .curvature_kind = true};
  for (const Isa isa : available_isas()) {
    for (const Layout layout : {Layout::blocks, Layout::interleaved}) {
      for (const QuantityFlags& outputs : {positions, normals, tangents, curvatures}) {
        add({"bicubic1000", 9, outputs, layout, isa});
        for (const int size : {9, 33}) {
          add({large_set(size, outputs), size, outputs, layout, isa, 1, Stores::plain});
          add({large_set(size, outputs), size, outputs, layout, isa, 2, Stores::streaming});
        }
        for (const int size : {4, 5, 8, 9, 16, 33})
          if (size != 33 || !outputs.duu)
            add({large_set(size, outputs), size, outputs, layout, isa, 1, Stores::streaming});
        add({"bicubic20000", 9, outputs, layout, isa, 1, Stores::streaming, true});
      }
      add({"rational1000", 9, positions, layout, isa});
      add({"bicubic20000", 9, positions, layout, isa, 1, Stores::automatic, false, true});
      for (const int size : {9, 33}) {
        const std::string patches = size == 9 ? "100000" : "20000";
        add({"rational" + patches, size, positions, layout, isa, 1, Stores::streaming});
        add({"bicubic" + patches, size, positions, layout, isa, 1, Stores::streaming, false, true});
      }
    }
    for (const QuantityFlags& outputs : {positions, normals, tangents})
      for (const Layout layout : {Layout::blocks, Layout::interleaved})
        for (const int size : {9, 33}) {
          add({"teapot", size, outputs, layout, isa, 1});
          add({"bicubic20000", size, outputs, layout, isa, 1});
        }
    for (const char* const set : {"bicubic100", "bicubic1000", "rational1000", "teapot", "bicubic20000"})
      add({set, 9, normals, Layout::vertices, isa});
    for (const int size : {4, 5, 8, 16, 33}) add({"bicubic100", size, normals, Layout::vertices, isa});
    add({"bicubic100", 9, normals, Layout::interleaved, isa});
    add({"bicubic100", 9, normals, Layout::blocks, isa});
    for (const Layout layout : {Layout::blocks, Layout::interleaved}) {
      add({"bicubic20000", 33, positions, layout, isa, 2});
      for (const QuantityFlags& outputs : {curvatures, geometry}) {
        add({"teapot", 9, outputs, layout, isa, 1});
        add({"teapot", 33, outputs, layout, isa, 1});
        add({"bicubic20000", 9, outputs, layout, isa, 1});
      }
    }
  }
  return true;
}();

}}  // namespace tessera::bench
