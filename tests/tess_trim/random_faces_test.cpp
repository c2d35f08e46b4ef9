// Random faces that share their edges: loops along sides and beside them by the last bits, of no length, tiny, crossing
// each other and running back over themselves. Each must become a mesh or an error, in bounded time.
//
// TESSERA_RANDOM_FACES in the environment is the number of shapes, 2 faces each.

#include <array>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <random>
#include <thread>

#include "tess_trim/closed_shape.h"
#include "tess_trim/trimmed_face.h"

namespace tessera::test { namespace {

constexpr std::uint64_t max_triangles = 60000;

/// Makes shapes of two faces with as many loops and curves each: the k-th curves of both share an edge. So the shape is
/// closed, wherever its faces lie.
class ShapeMaker {
 public:
  explicit ShapeMaker(unsigned seed) : random_(seed) {}

  Shape make() {
    Shape shape;
    const std::size_t loops = one_of({1, 1, 1, 2, 3});
    std::vector<std::size_t> counts(loops);
    for (std::size_t& count : counts) count = one_of({1, 2, 3, 4, 4, 5, 8});
    const bool is_turned = is(0.5);
    for (const bool second : {false, true}) {
      const BSplineSurface surface = this->surface();
      box_ = domain_of(surface);
      ModelSurface face{.name = std::string(second ? "second" : "first"), .surface = surface};
      std::vector<TrimLoop> made;
      std::uint32_t edge = 0;
      for (const std::size_t count : counts) made.push_back(loop(count, edge, second && is_turned));
      face.trims = std::move(made);
      shape.faces.push_back({std::move(face)});
    }
    std::size_t edges = 0;
    for (const std::size_t count : counts) edges += count;
    shape.edges.resize(edges);
    for (BrepEdge& edge : shape.edges) edge.range = {0, 1};
    shape.shells = {{{0, 1}, 0}};
    shape.solid_count = 1;
    return shape;
  }

 private:
  double number(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
  bool is(double probability) { return number(0, 1) < probability; }
  std::size_t one_of(std::initializer_list<std::size_t> list) {
    return list.begin()[std::uniform_int_distribution<std::size_t>(0, list.size() - 1)(random_)];
  }
  static Domain domain_of(const BSplineSurface& surface) { return surface.domain(); }

  BSplineSurface surface() {
    switch (one_of({0, 1, 2, 3})) {
      case 0:
        return plane();
      case 1:
        return cylinder();
      case 2:
        return wavy();
      default:
        return cone();
    }
  }
  /// A patch with a pole along u = 0, over [0, 4] x [0, 3].
  static BSplineSurface cone() {
    const std::vector<double> u{0, 0, 4, 4}, v{0, 0, 0, 3, 3, 3};
    const std::vector<Vec3> points{{0, 0, 2}, {0, 0, 2}, {0, 0, 2}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}};
    return value_of(BSplineSurface::polynomial(1, u, 2, v, points));
  }

  /// A value on a line between patches, beside it by a few bits, or anywhere.
  double value(double from, double to) {
    static constexpr double offsets[] = {0, 0, 0, 1e-16, -1e-16, 1e-13, -1e-13, 1e-9, -1e-9, 1e-6, -1e-4, 1e-3};
    if (is(0.4)) return number(from, to);
    const double line = from + std::floor(number(0, to - from + 1));
    const double at = line + offsets[std::uniform_int_distribution<std::size_t>(0, std::size(offsets) - 1)(random_)];
    return is(0.1) ? at : std::clamp(at, from, to);
  }
  Vec3 point() { return {value(box_.u0, box_.u1), value(box_.v0, box_.v1), 0}; }
  /// The next corner of a loop: often on one line with the last one, sometimes the same or the one before.
  Vec3 corner(const std::vector<Vec3>& corners) {
    if (corners.empty()) return point();
    const Vec3 last = corners.back();
    if (is(0.08)) return last;
    if (corners.size() > 1 && is(0.08)) return corners[corners.size() - 2];
    if (is(0.05)) return last + Vec3{number(-1e-9, 1e-9), number(-1e-9, 1e-9), 0};
    Vec3 next = point();
    if (is(0.5)) (is(0.5) ? next.x : next.y) = is(0.5) ? last.x : last.y;
    return next;
  }

  Curve curve(const Vec3& from, const Vec3& to) {
    const std::vector<double> linear{0, 0, 1, 1}, quadratic{0, 0, 0, 1, 1, 1}, cubic{0, 0, 0, 0, 1, 1, 1, 1};
    const Vec3 middle = 0.5 * (from + to);
    const auto beside = [&] {
      const double reach = is(0.3) ? 1e-6 : 0.7;
      return Vec3{std::clamp(middle.x + number(-reach, reach), box_.u0, box_.u1),
                  std::clamp(middle.y + number(-reach, reach), box_.v0, box_.v1), 0};
    };
    if (is(0.6)) return value_of(Curve::b_spline(1, std::array{from, to}, linear));
    if (is(0.5))
      return value_of(Curve::nurbs(2, std::array{from, beside(), to}, std::array{1.0, number(0.2, 3), 1.0}, quadratic));
    return value_of(Curve::b_spline(3, std::array{from, beside(), beside(), to}, cubic));
  }

  TrimLoop loop(std::size_t count, std::uint32_t& edge, bool is_turned) {
    std::vector<Vec3> corners;
    for (std::size_t k = 0; k < count; ++k) corners.push_back(corner(corners));
    TrimLoop loop;
    for (std::size_t k = 0; k < count; ++k) {
      loop.curves.push_back(curve(corners[k], corners[(k + 1) % count]));
      loop.coedges.push_back(
          {.edge = edge + static_cast<std::uint32_t>(is_turned ? count - 1 - k : k), .reversed = is_turned});
    }
    edge += static_cast<std::uint32_t>(count);
    return loop;
  }

  std::mt19937 random_;
  Domain box_;
};

/// Sets a flag if a step takes more than `seconds` of processor time, and says which one.
class Watch {
 public:
  explicit Watch(int seconds) : seconds_(seconds), thread_([this](const std::stop_token& stop) { run(stop); }) {}
  void begin(unsigned step) {
    cancel = false;
    step_ = step;
  }
  std::atomic<bool> cancel = false;

 private:
  void run(const std::stop_token& stop) {
    unsigned seen = step_;
    std::clock_t since = std::clock();
    for (; !stop.stop_requested(); std::this_thread::sleep_for(std::chrono::milliseconds(100))) {
      if (seen != step_) seen = step_, since = std::clock();
      const double spent = static_cast<double>(std::clock() - since) / CLOCKS_PER_SEC;
      if (spent > seconds_) cancel = true;
      if (spent > 2 * seconds_) std::fprintf(stderr, "shape %u does not heed a cancel\n", seen), std::abort();
    }
  }
  int seconds_;
  std::atomic<unsigned> step_ = 0;
  std::jthread thread_;
};

/// Counts of what shapes became.
struct Counts {
  unsigned meshed = 0, refused = 0, beyond = 0, crossed = 0, open = 0, claimed = 0;
};

/// Meshes a shape; its numbers must be finite, and its errors must say why.
void mesh(const Shape& shape, Watch& watch, Counts& counts) {
  const Result<PatchSet> set = make_patch_set(shape);
  if (!set) {
    EXPECT_FALSE(set.status().message().empty());
    ++counts.refused;
    return;
  }
  const Execution execution{.cancel = &watch.cancel};
  const Result<Tessellation> plan =
      Tessellation::make(*set, {.tolerance = 0.02, .max_triangles = max_triangles}, execution);
  if (!plan) {
    EXPECT_EQ(plan.status().code(), StatusCode::invalid_argument) << plan.status().message();
    EXPECT_FALSE(plan.status().message().empty());
    ++counts.refused;
    return;
  }
  Mesh mesh = value_of(plan->allocate());
  const Status status = plan->run(*set, mesh.views(), execution);
  ASSERT_TRUE(status.ok()) << status.message();
  const MeshReport report = value_of(check(mesh));
  EXPECT_EQ(report.non_finite_vertices, 0u);
  EXPECT_TRUE(std::isfinite(plan->bound()) && std::isfinite(plan->gap()));
  EXPECT_TRUE(plan->bound() <= 0.02 * (1 + 1e-6) || !plan->patches_beyond_tolerance().empty());
  ++counts.meshed;
  counts.beyond += !plan->patches_beyond_tolerance().empty();
  counts.crossed += !plan->crossed_patches().empty();
  counts.open += report.open_edges > 0;
  counts.claimed += report.open_edges > 0 && plan->open_edges() == 0;
}

TEST(RandomFaces, BecomeMeshesOrErrors) {
  const char* const wanted = std::getenv("TESSERA_RANDOM_FACES");
  const char* const from = std::getenv("TESSERA_RANDOM_FACES_FROM");
  const unsigned count = wanted ? static_cast<unsigned>(std::atol(wanted)) : 1500;
  const unsigned first = from ? static_cast<unsigned>(std::atol(from)) : 1;
  Counts counts;
  Watch watch(10);
  for (unsigned seed = first; seed < first + count && !HasFatalFailure(); ++seed) {
    SCOPED_TRACE(seed);
    watch.begin(seed);
    mesh(ShapeMaker(seed).make(), watch, counts);
  }
  std::printf(
      "%u shapes: %u meshed (%u beyond the tolerance, %u crossed, %u open, %u of these said to be closed), %u "
      "refused\n",
      count, counts.meshed, counts.beyond, counts.crossed, counts.open, counts.claimed, counts.refused);
  EXPECT_GT(counts.meshed, count / 2);
  // Where loops run over each other within the rounding of positions, the plan's count is not exact: check() is.
  EXPECT_LE(counts.claimed, 1 + count / 50);
}

}}  // namespace tessera::test
