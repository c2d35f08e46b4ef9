// Every call that evaluates writes all outputs that it is asked for, whatever the others are, and nothing else: each
// output alone is compared with the reference, and combinations are compared with the outputs alone, bit by bit.
//
// The code that runs depends on outputs, degrees, layouts and stores, so fast paths are tested here without being
// named.

#include <cmath>
#include <functional>
#include <string>

#include "eval/output_memory.h"
#include "support/lecture_surfaces.h"
#include "support/points.h"
#include "support/reference.h"
#include "tessera/model.h"

namespace tessera::test { namespace {

/// A place on a patch.
struct Place {
  std::size_t patch;
  double u, v;
};

/// A way to evaluate into one kind of memory.
template <class Memory>
struct Form {
  std::function<Memory(OutputMask)> memory;
  std::function<Status(Memory&)> run;
  std::vector<std::uint8_t> written = {};  ///< by record; empty: all
};

/// Each output alone.
template <class Memory>
OutputBytes alone(const Form<Memory>& form) {
  OutputBytes all(output_count);
  for (std::size_t output = 0; output < output_count; ++output) {
    auto memory = form.memory(OutputMask{1} << output);
    const Status status = form.run(memory);
    EXPECT_TRUE(status.ok()) << status.message();
    all[output] = memory.bytes(output);
  }
  return all;
}

template <class Memory>
void expect_combinations(const Form<Memory>& form, const OutputBytes& all, std::span<const OutputMask> masks,
                         const std::string& what) {
  std::size_t wrong = 0;
  for (const OutputMask mask : masks) {
    auto memory = form.memory(mask);
    const Status status = form.run(memory);
    ASSERT_TRUE(status.ok()) << status.message();
    if (memory.holds(all, form.written)) continue;
    if (wrong++ == 0) ADD_FAILURE() << what << ": the outputs " << std::hex << mask << " together";
  }
  EXPECT_EQ(wrong, 0u) << what << ": so many of " << masks.size() << " combinations";
}

/// Compares outputs alone, of patches in [0,1]^2, with the reference. `loss`: how much worse than by the Bernstein
/// form.
template <class T>
void expect_reference(const PatchSet& set, const std::vector<Place>& places, const OutputBytes& all,
                      const std::function<double(const Place&)>& loss, const std::string& what) {
  std::size_t record = 0;
  for (const Place& at : places) {
    const std::size_t k = record++;
    const BezierPatch patch = set.patch(at.patch);
    if (patch.collapsed_sides().any()) continue;
    const RealJet jet = reference_jet(patch, at.u, at.v);
    const RealGeometry g = reference_geometry(jet);
    const RealVec3 origin = sizeof(T) == 4 ? RealVec3{set.origin().x, set.origin().y, set.origin().z} : RealVec3{};
    const RealVec3 vectors[] = {jet.position - origin,
                                jet.du,
                                jet.dv,
                                g.normal,
                                jet.duu,
                                jet.duv,
                                jet.dvv,
                                g.first_form,
                                g.second_form,
                                g.first_direction,
                                g.second_direction};
    const Real scalars[] = {g.gaussian, g.mean, g.first, g.second};
    const double most = (sizeof(T) == 4 ? 4e-3 : 1e-11) * loss(at);
    std::size_t output = 0;
    const auto value = [&](std::size_t c, std::size_t width) {
      T x;
      std::memcpy(&x, all[output].data() + (k * width + c) * sizeof(T), sizeof(T));
      return static_cast<double>(x);
    };
    for (const RealVec3& v : vectors) {
      const Vec3 found{value(0, 3), value(1, 3), value(2, 3)}, right = v.rounded();
      const bool is_direction = output == 9 || output == 10;
      const double off = is_direction ? std::min(length(found - right), length(found + right)) : length(found - right);
      EXPECT_LE(off, most * (1 + length(right))) << what << ": output " << output << ", record " << k;
      ++output;
    }
    for (const Real right : scalars) {
      EXPECT_NEAR(value(0, 1), double(right), most * (1 + std::abs(double(right))))
          << what << ": output " << output << ", record " << k;
      ++output;
    }
    EXPECT_EQ(all[output][k], std::byte(NormalKind::regular)) << what;
    EXPECT_EQ(all[output + 1][k], std::byte(CurvatureKind::distinct)) << what;
  }
}

/// A saddle over the unit square with a little noise: well-shaped, with principal curvatures that differ.
BezierPatch saddle(Random& random, int m, int n, bool is_rational) {
  std::vector<Vec3> points;
  for (int i = 0; i <= m; ++i)
    for (int j = 0; j <= n; ++j) {
      const double u = double(i) / m, v = double(j) / n, noise = 0.03 / (m * n);
      points.push_back(Vec3{u, v, 0.5 * (u * u - 0.7 * v * v) + 0.4 * u * v} + noise * uniform_vector(random, -1, 1));
    }
  return is_rational ? rational(m, n, points, random_weights(random, m, n, 0.9, 1.1)) : polynomial(m, n, points);
}

/// One block and a part of another. The last patch has a pole, where kernels leave their usual way.
std::vector<BezierPatch> patches_of(int m, int n, bool is_rational, int count = 18) {
  Random random(static_cast<std::uint64_t>(100 * m + 10 * n + is_rational));
  std::vector<BezierPatch> patches;
  for (int k = 0; k + 1 < count; ++k) patches.push_back(saddle(random, m, n, is_rational));
  const BezierPatch last = saddle(random, m, n, is_rational);
  std::vector<Vec3> points(last.points().begin(), last.points().end());
  std::fill_n(points.begin(), n + 1, points[0]);
  patches.push_back(value_of(last.with_points(points)));
  return patches;
}

PatchSet set_with_all(const std::vector<BezierPatch>& patches) {
  PatchSetOptions options;
  options.blocks = {true, true, true, true, true, true};
  return set_of(patches, options);
}

std::vector<double> ends_and_more(int count) {
  std::vector<double> t;
  for (int k = 0; k < count; ++k) t.push_back(count == 1 ? 0.4 : double(k) / (count - 1));
  return t;
}

template <class T>
std::vector<Place> places_of(const GridPlan& plan, std::size_t patches, const std::vector<double>& u,
                             const std::vector<double>& v) {
  std::vector<Place> places;
  for (std::size_t k = 0; k < patches; ++k)
    for (std::size_t i = 0; i < plan.count_u(); ++i)
      for (std::size_t j = 0; j < plan.count_v(); ++j) places.push_back({k, u[i], v[j]});
  return places;
}

template <class T>
auto view_form(Layout layout, std::size_t records, auto run) {
  return Form<ViewMemory<T>>{[=](OutputMask mask) { return ViewMemory<T>(layout, mask, records); },
                             [=](ViewMemory<T>& memory) { return run(memory.views()); }};
}
template <class T>
auto block_form(std::size_t records, auto run) {
  return Form<BlockMemory<T>>{[=](OutputMask mask) { return BlockMemory<T>(mask, records); },
                              [=](BlockMemory<T>& memory) { return run(memory.blocks()); }};
}

const std::vector<OutputMask> pairs = masks_of(2), triples = masks_of(3);

/// A grid of one set in all layouts, plain and streamed.
template <class T>
void check_grid(const PatchSet& set, const GridPlan& plan, const std::vector<Place>& places,
                std::span<const OutputMask> masks, const std::function<double(const Place&)>& loss,
                const std::string& what) {
  for (const Stores stores : {Stores::plain, Stores::streaming}) {
    const auto run = [&](const auto& out) { return evaluate(set, plan, out, {.stores = stores}); };
    const auto arrays = view_form<T>(Layout::arrays, plan.capacity(), run);
    const OutputBytes all = alone(arrays);
    if (stores == Stores::plain && !places.empty()) expect_reference<T>(set, places, all, loss, what);
    expect_combinations(arrays, all, masks, what + ", arrays");
    for (const Layout layout : {Layout::columns, Layout::records, Layout::gaps})
      expect_combinations(view_form<T>(layout, plan.capacity(), run), all, stores == Stores::plain ? pairs : masks,
                          what + ", layout " + std::to_string(int(layout)));
    const auto blocks = block_form<T>(plan.block_capacity() / (3 * PatchSet::lanes), run);
    const OutputBytes in_blocks = alone(blocks);
    for (std::size_t output = 0; output < output_count; ++output) {  // the same numbers at other places
      const std::size_t samples = plan.count_u() * plan.count_v(), bytes = all[output].size() / plan.capacity();
      const std::size_t size = output < vector_quantities ? sizeof(T) : bytes, width = bytes / size;
      for (std::size_t k = 0; k < plan.capacity(); ++k)
        for (std::size_t c = 0; c < width; ++c) {
          const PatchSet::Slot slot = set.slot(k / samples);
          const std::size_t at = ((slot.block * samples + k % samples) * width + c) * PatchSet::lanes + slot.lane;
          ASSERT_EQ(std::memcmp(&in_blocks[output][at * size], &all[output][(k * width + c) * size], size), 0)
              << what << ": output " << output << " of record " << k << " in blocks";
        }
    }
    expect_combinations(blocks, in_blocks, masks, what + ", blocks");
  }
}

const auto no_loss = [](const Place&) { return 1.0; };

template <class T>
void check_grids(int m, int n, bool is_rational, Representation representation, std::span<const OutputMask> masks,
                 int count_u, int count_v) {
  const PatchSet set = set_with_all(patches_of(m, n, is_rational));
  const std::vector<double> u = ends_and_more(count_u), v = ends_and_more(count_v);
  const GridPlan plan =
      value_of(GridPlan::make(set, u, v, {.precision = precision_of<T>, .representation = representation}));
  const auto loss = [=](const Place& at) {
    return representation == Representation::bernstein ? 1 : std::pow(1 + 2 * at.u, m) * std::pow(1 + 2 * at.v, n);
  };
  check_grid<T>(set, plan, places_of<T>(plan, set.patch_count(), u, v), masks, loss,
                "degrees " + std::to_string(m) + " x " + std::to_string(n) + (is_rational ? ", rational" : "") +
                    (sizeof(T) == 4 ? ", float" : ", double"));
}

TEST(OutputCombinations, AllOfABicubicGridInFloat) {
  const PatchSet set = set_with_all(patches_of(3, 3, false, 3));
  const std::vector<double> t = ends_and_more(2);
  const GridPlan plan = value_of(GridPlan::make(set, t, t));
  std::vector<OutputMask> masks;
  for (OutputMask mask = 1; mask <= every_output; ++mask) masks.push_back(mask);
  const auto run = [&](const auto& out) { return evaluate(set, plan, out); };
  const auto blocks = block_form<float>(plan.block_capacity() / (3 * PatchSet::lanes), run);
  expect_combinations(blocks, alone(blocks), masks, "blocks");
  const auto arrays = view_form<float>(Layout::arrays, plan.capacity(), run);
  expect_combinations(arrays, alone(arrays), masks, "arrays");
}

TEST(OutputCombinations, GridsOfEachDegree) {
  for (int degree = 1; degree <= 6; ++degree)
    for (const bool is_rational : {false, true}) {
      check_grids<float>(degree, degree, is_rational, Representation::bernstein, triples, 2, 3);
      check_grids<double>(degree, degree, is_rational, Representation::bernstein, triples, 2, 3);
    }
}

TEST(OutputCombinations, GridsOfMixedDegreesAndLongRows) {
  for (const bool is_rational : {false, true}) {
    check_grids<float>(3, 1, is_rational, Representation::bernstein, pairs, 3, 2);
    check_grids<double>(2, 5, is_rational, Representation::bernstein, pairs, 2, 2);
    check_grids<float>(3, 3, is_rational, Representation::bernstein, pairs, 2, 17);
    check_grids<double>(3, 3, is_rational, Representation::bernstein, pairs, 1, 16);
  }
}

TEST(OutputCombinations, GridsOfThePowerForm) {
  for (int degree = 1; degree <= 3; ++degree)
    for (const bool is_rational : {false, true}) {
      check_grids<float>(degree, degree, is_rational, Representation::power, pairs, 2, 2);
      check_grids<double>(degree, degree, is_rational, Representation::power, pairs, 2, 2);
    }
}

/// Parameters of each patch's own.
template <class T>
void check_own_parameters(int degree, bool is_rational) {
  const PatchSet set = set_with_all(patches_of(degree, degree, is_rational));
  Random random(7);
  std::vector<double> u(2 * set.patch_count()), v(2 * set.patch_count());
  for (double& t : u) t = uniform(random, 0, 1);
  for (double& t : v) t = uniform(random, 0, 1);
  const GridPlan plan = value_of(GridPlan::make(set, PatchParameters{u, v}, {.precision = precision_of<T>}));
  std::vector<Place> places;
  for (std::size_t k = 0; k < set.patch_count(); ++k)
    for (const std::size_t i : {0u, 1u})
      for (const std::size_t j : {0u, 1u}) places.push_back({k, u[2 * k + i], v[2 * k + j]});
  check_grid<T>(set, plan, places, pairs, no_loss, "own parameters");
}

TEST(OutputCombinations, GridsWithParametersOfTheirOwn) {
  for (const int degree : {1, 3, 4})
    for (const bool is_rational : {false, true}) {
      check_own_parameters<float>(degree, is_rational);
      check_own_parameters<double>(degree, is_rational);
    }
}

/// Scattered samples, by patches in and out of order, and by surfaces.
template <class T>
void check_points(int degree, bool is_rational) {
  PatchSetOptions options;
  options.blocks.float_points = options.blocks.double_points = true;
  Model model;
  for (const BezierPatch& patch : patches_of(degree, degree, is_rational, 5))
    model.surfaces.push_back({.name = {}, .surface = patch});
  const PatchSet set = value_of(make_patch_set(model, options));
  Random random(9);
  Samples<T> sorted;
  for (std::size_t k = 0; k < 21 * set.patch_count(); ++k)
    sorted.add(k / 21, T(uniform(random, 0, 1)), k % 5 == 0 ? T(0) : T(uniform(random, 0, 1)));
  const std::string what = "points of degree " + std::to_string(degree);
  for (const Samples<T>& samples : {sorted, sorted.in_order(shuffled_order(random, sorted.size()))}) {
    std::vector<Place> places;
    for (std::size_t k = 0; k < samples.size(); ++k)
      places.push_back({samples.patch[k], double(samples.u[k]), double(samples.v[k])});
    const auto run = [&](const auto& out) { return evaluate(set, samples.views(), out); };
    const auto arrays = view_form<T>(Layout::arrays, samples.size(), run);
    const OutputBytes all = alone(arrays);
    expect_reference<T>(set, places, all, no_loss, what);
    expect_combinations(arrays, all, triples, what);
    for (const Layout layout : {Layout::columns, Layout::records, Layout::gaps})
      expect_combinations(view_form<T>(layout, samples.size(), run), all, pairs, what);
  }
  const SurfaceMap map = value_of(SurfaceMap::make(set));
  const std::vector<double> u(sorted.u.begin(), sorted.u.end()), v(sorted.v.begin(), sorted.v.end());
  const SurfaceSamples samples{View1<const std::uint32_t>::interleaved(sorted.patch),
                               View1<const double>::interleaved(u), View1<const double>::interleaved(v)};
  const auto by_surface =
      view_form<T>(Layout::arrays, sorted.size(), [&](const auto& out) { return evaluate(set, map, samples, out); });
  std::vector<Place> places;
  for (std::size_t k = 0; k < sorted.size(); ++k) places.push_back({sorted.patch[k], u[k], v[k]});
  const OutputBytes all = alone(by_surface);
  expect_reference<T>(set, places, all, no_loss, what + " by surfaces");
  expect_combinations(by_surface, all, pairs, what + " by surfaces");
}

TEST(OutputCombinations, ScatteredPoints) {
  for (int degree = 1; degree <= 6; ++degree)
    for (const bool is_rational : {false, true}) {
      check_points<float>(degree, is_rational);
      check_points<double>(degree, is_rational);
    }
}

/// Updates of three patches of two blocks.
template <class T>
void check_updates(int degree, bool is_rational) {
  PatchSet set = set_with_all(patches_of(degree, degree, is_rational, 40));
  const std::vector<double> u = ends_and_more(2), v = ends_and_more(3);
  const GridPlan plan = value_of(GridPlan::make(set, u, v, {.precision = precision_of<T>}));
  GridUpdate update = value_of(GridUpdate::make(set));
  const std::vector<std::uint32_t> edited{2, 35, 38};
  Random random(11);
  std::vector<Vec3> points;
  for (std::size_t k = 0; k < edited.size(); ++k) {
    const BezierPatch patch = saddle(random, degree, degree, is_rational);
    points.insert(points.end(), patch.points().begin(), patch.points().end());
  }
  const auto run = [&](const auto& out) { return update.run(set, plan, PatchEdits{edited, points}, out); };
  const auto anew = [&](const auto& out) { return evaluate(set, plan, out); };
  const std::size_t samples = plan.count_u() * plan.count_v(),
                    in_blocks = plan.block_capacity() / (3 * PatchSet::lanes);
  std::vector<std::uint8_t> patches(plan.capacity(), 0), blocks(in_blocks, 0);
  for (const std::uint32_t k : edited) {
    std::fill_n(patches.begin() + std::ptrdiff_t(k * samples), samples, 1);
    std::fill_n(blocks.begin() + std::ptrdiff_t(set.slot(k).block * samples), samples, 1);
  }
  const std::string what = "updates of degree " + std::to_string(degree);
  (void)alone(view_form<T>(Layout::arrays, plan.capacity(), run));  // makes the edits
  const OutputBytes all = alone(view_form<T>(Layout::arrays, plan.capacity(), anew));
  expect_reference<T>(set, places_of<T>(plan, set.patch_count(), u, v), all, no_loss, what);
  for (const Layout layout : {Layout::arrays, Layout::columns, Layout::records, Layout::gaps}) {
    auto views = view_form<T>(layout, plan.capacity(), run);
    views.written = patches;
    expect_combinations(views, all, pairs, what);
  }
  auto into_blocks = block_form<T>(in_blocks, run);
  into_blocks.written = blocks;
  expect_combinations(into_blocks, alone(block_form<T>(in_blocks, anew)), pairs, what + ", blocks");
}

TEST(OutputCombinations, UpdatesOfTouchedBlocks) {
  for (const int degree : {2, 3})
    for (const bool is_rational : {false, true}) {
      check_updates<float>(degree, is_rational);
      check_updates<double>(degree, is_rational);
    }
}

}}  // namespace tessera::test
