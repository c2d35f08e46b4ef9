// Random edits that change the topology, with all options: bounds hold by samples of mesh and surfaces, neighbours keep
// the same border points, and where nothing ties a plan to what was before, it is the plan that a new set would get.
//
// TESSERA_EDITS: how many edits; TESSERA_FIRST_SET: the seed of the first set.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>

#include "support/sampled_distance.h"
#include "tess/proven_mesh_of.h"
#include "tess/random_edits.h"

namespace tessera::test { namespace {

constexpr std::uint64_t edits_of_a_quick_run = 600;

std::uint64_t number_of(const char* variable, std::uint64_t otherwise) {
  const char* const text = std::getenv(variable);
  return text ? std::strtoull(text, nullptr, 10) : otherwise;
}

TessellationOptions random_options(Random& random, double size) {
  const auto one_of = [&](std::uint64_t count) { return random() % count == 0; };
  TessellationOptions options{.tolerance = size * std::pow(10.0, uniform(random, -2.3, -0.7))};
  options.joining.share_vertices = one_of(2);
  if (one_of(3)) options.joining.crease_angle = uniform(random, 0.05, 3);
  if (one_of(4))
    options.joining.weld = 0;
  else if (one_of(3))
    options.joining.weld = size * std::pow(10.0, uniform(random, -6, -1.35));
  if (one_of(5)) options.angle = uniform(random, 0.5, 1.5);
  options.angle_rate = 6;
  options.quads = one_of(3);
  options.fewest = one_of(12);
  options.spare = one_of(2) ? 0 : 0.25;
  if (one_of(4)) options.precision = Precision::double_precision;
  options.max_triangles = 3000;
  return options;
}

struct Counts {
  std::size_t edits = 0, topologies = 0, refused = 0, compared = 0, closed = 0, borders = 0, samples = 0;
};

/// A set that follows edits, and what is known of it.
class EditedTopologyFollowed {
 public:
  EditedTopologyFollowed(Random& random, Counts& counts)
      : random_(random),
        counts_(counts),
        set_(set_of(random_set(random))),
        options_(random_options(random, set_.box().diagonal())) {}

  /// Makes the plan. Returns whether there is one.
  bool start() {
    Result<Tessellation> made = Tessellation::make(set_, options_);
    if (!made) return false;
    plan_.emplace(*std::move(made));
    mesh_ = mesh_of(set_, *plan_);
    was_closed_ = good(check(mesh_)).closed();
    compare();
    return true;
  }
  /// Returns false if no mesh keeps the tolerance.
  bool edit() {
    RandomEdits edits(set_, random_);
    const bool parts = random_() % 2 == 0;
    stays_together_ = stays_together_ && !parts;
    const auto change = plan_->update(set_, parts ? edits.apart() : edits.together(), mesh_.views());
    ++counts_.edits;
    if (!change) {
      EXPECT_EQ(change.status().code(), StatusCode::invalid_argument) << change.status().message();
      ++counts_.refused;
      return false;
    }
    const Mesh anew = mesh_of(set_, *plan_);
    if (change->topology) {
      ++counts_.topologies;
    } else {
      EXPECT_EQ(mesh_.positions, anew.positions);
      EXPECT_EQ(mesh_.model_positions, anew.model_positions);
      EXPECT_EQ(mesh_.normals, anew.normals);
    }
    mesh_ = anew;
    if (change->topology) compare_with_new_plan();
    compare();
    return true;
  }

 private:
  /// Checks that hold for any plan and its mesh.
  void compare() {
    EXPECT_LE(plan_->bound(), *options_.tolerance * (1 + 1e-6));
    expect_bounds();
    if (stays_together_) expect_same_borders();
    if (!stays_together_ || !was_closed_) return;
    EXPECT_TRUE(good(check(mesh_)).closed());
    ++counts_.closed;
  }

  void expect_bounds() {
    const SampledMesh sampled(mesh_, set_.patch_count(), random_() % 2 == 0);
    for (std::size_t k = 0; k < set_.patch_count(); ++k) {
      if (proven_mesh_of(*plan_).plan().division(k).empty) continue;  // a curve, which has no triangles
      const double bound = double(plan_->bounds()[k]) * (1 + 1e-6);
      for (int sample = 0; sample < 16; ++sample, ++counts_.samples) {
        const auto parameter = [&] { return std::clamp(uniform(random_, -0.1, 1.1), 0.0, 1.0); };
        const double u = parameter(), v = parameter(),
                     found = sampled.distance(de_casteljau(set_.patch(k), u, v), k, bound);
        EXPECT_LE(found, bound) << "from patch " << k << " at " << u << ", " << v;
      }
      if (sampled.faces(k).empty()) continue;
      for (int sample = 0; sample < 4; ++sample, ++counts_.samples) {
        const auto& face = sampled.faces(k)[static_cast<std::size_t>(random_() % sampled.faces(k).size())];
        double a = uniform(random_, 0, 1), b = uniform(random_, 0, 1);
        if (a + b > 1) a = 1 - a, b = 1 - b;
        const Vec3 p = a * face.corners[0] + b * face.corners[1] + (1 - a - b) * face.corners[2];
        const double most = bound + 1e-7 * set_.box().diagonal();  // what distance_to_patch() finds
        EXPECT_LE(distance_to_patch(set_.patch(k), p, most), most) << "from the mesh to patch " << k;
      }
    }
  }

  using Side4 = std::vector<std::array<double, 4>>;
  /// The control points of a side, or those from its other end if these are less.
  Side4 side_of(std::size_t patch, Side side) const {
    const BezierPatch& p = set_.patch(patch);
    const int count = runs_along_u(side) ? p.degree_u() : p.degree_v();
    Side4 points;
    for (int k = 0; k <= count; ++k) {
      const int i = runs_along_u(side) ? k
                    : side == Side::u0 ? 0
                                       : p.degree_u(),
                j = runs_along_u(side) ? (side == Side::v0 ? 0 : p.degree_v()) : k;
      points.push_back({p.point(i, j).x, p.point(i, j).y, p.point(i, j).z, p.weight(i, j)});
    }
    return std::min(points, Side4(points.rbegin(), points.rend()));
  }
  /// The positions of a mesh's vertices on a side, in order.
  std::vector<std::array<double, 3>> vertices_on(const SampledMesh& sampled, std::size_t patch, Side side) const {
    std::vector<std::array<double, 3>> on;
    for (const SampledMesh::Face& face : sampled.faces(patch))
      for (const std::uint32_t k : face.vertices) {
        const float across = mesh_.parameters[2 * k + (runs_along_u(side) ? 1 : 0)];
        if (across != (side == Side::u0 || side == Side::v0 ? 0 : 1)) continue;
        const Vec3 p = sampled.position(k);
        on.push_back({p.x, p.y, p.z});
      }
    std::ranges::sort(on);
    on.erase(std::unique(on.begin(), on.end()), on.end());
    return on;
  }
  /// Borders of the same control points have vertices of the same bits.
  void expect_same_borders() {
    if (options_.joining.share_vertices) return;  // parameters of a shared vertex are those of one patch
    const SampledMesh sampled(mesh_, set_.patch_count(), false);
    std::map<Side4, std::vector<std::array<double, 3>>> known;
    for (std::size_t k = 0; k < set_.patch_count(); ++k)
      for (const Side side : all_sides) {
        if (sampled.faces(k).empty()) continue;
        const auto [found, is_new] = known.try_emplace(side_of(k, side), vertices_on(sampled, k, side));
        if (is_new) continue;
        EXPECT_EQ(found->second, vertices_on(sampled, k, side)) << "side " << int(side) << " of patch " << k;
        ++counts_.borders;
      }
  }

  /// A plan that divides each patch as a new one would is the new one, unless it keeps borders that were joined.
  void compare_with_new_plan() {
    const Result<Tessellation> fresh = Tessellation::make(set_, options_);
    if (!fresh) {  // kept segments may have fewer triangles than new ones
      EXPECT_NE(fresh.status().message().find("the limits are"), std::string::npos) << fresh.status().message();
      return;
    }
    if (!stays_together_ || plan_->welded_borders() + fresh->welded_borders() > 0) return;
    const CertifiedPlan &ours = proven_mesh_of(*plan_).plan(), &theirs = proven_mesh_of(*fresh).plan();
    const bool has_f64 = !ours.patches().rare->f64_patches.empty() ||
                         !theirs.patches().rare->f64_patches.empty();  // which border leads is kept too
    if (has_f64 || !std::ranges::equal(ours.patches().segments, theirs.patches().segments)) return;
    const Mesh anew = mesh_of(set_, *fresh);
    EXPECT_EQ(mesh_.indices, anew.indices);
    EXPECT_EQ(mesh_.quads, anew.quads);
    EXPECT_EQ(mesh_.positions, anew.positions);
    EXPECT_EQ(mesh_.normals, anew.normals);
    ++counts_.compared;
  }

  Random& random_;
  Counts& counts_;
  PatchSet set_;
  TessellationOptions options_;
  std::optional<Tessellation> plan_;
  Mesh mesh_;
  bool stays_together_ = true, was_closed_ = false;
};

TEST(EditedTopology, BoundsAndNeighboursHold) {
  const std::uint64_t wanted = number_of("TESSERA_EDITS", edits_of_a_quick_run);
  Counts counts;
  for (std::uint64_t seed = number_of("TESSERA_FIRST_SET", 1); counts.edits < wanted; ++seed) {
    SCOPED_TRACE("set " + std::to_string(seed));
    Random random(seed);
    EditedTopologyFollowed body(random, counts);
    if (!body.start()) continue;
    for (int k = 0; k < 8 && body.edit(); ++k) {
    }
    if (HasFailure() && wanted == edits_of_a_quick_run) break;
  }
  std::printf(
      "%zu edits, %zu new topologies, %zu refused, %zu like new plans, %zu closed, %zu common borders, %zu samples\n",
      counts.edits, counts.topologies, counts.refused, counts.compared, counts.closed, counts.borders, counts.samples);
  EXPECT_GT(counts.topologies, wanted / 4);
  EXPECT_GT(counts.compared, wanted / 40);
  EXPECT_GT(counts.closed, wanted / 40);
  EXPECT_GT(counts.borders, wanted / 4);
}

}}  // namespace tessera::test
