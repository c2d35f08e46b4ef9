// Checks that certified tessellations keep their bounds on random patches that are difficult: weight ratios up to a
// million, degrees up to 15, scaled sweeps and near ones, flat quadrilaterals, poles, thin patches, patches far from
// zero. Points of patches and meshes are measured against each other, by code that the bounds do not share.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <queue>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "support/random_patches.h"
#include "support/synthetic_sets.h"
#include "support/true_distance.h"
#include "tessera/bezier_operations.h"
#include "tessera/tessellation.h"

namespace {

using namespace tessera;
using test::Random;
using test::uniform;
using test::uniform_vector;

constexpr char usage[] =
    "tessera_random_certificate_report [PATCHES] [SEED]\n\n"
    "Meshes random patches (10,000; in sets of 16 that have the degrees in common) to random tolerances, and measures "
    "some of\n"
    "their triangles in both directions. Exit status 1 if a bound is exceeded.\n";

constexpr std::size_t patches_per_set = 16, triangles_per_patch = 4, points_per_triangle = 4;

enum Kind { rough, sweep, near_sweep, flat, pole, kinds };
constexpr const char* names[kinds] = {"random weights", "scaled sweeps", "nearly sweeps", "flat", "poles"};

struct Net {
  int m, n;
  std::vector<Vec3> points;
  std::vector<double> weights;
  Vec3& point(int i, int j) { return points[static_cast<std::size_t>(i * (n + 1) + j)]; }
  double& weight(int i, int j) { return weights[static_cast<std::size_t>(i * (n + 1) + j)]; }
};

double weight(Random& random, double spread) { return std::pow(10.0, uniform(random, -spread, spread) / 2); }

Net random_net(Random& random, Kind kind, int m, int n) {
  Net net{m, n, std::vector<Vec3>(static_cast<std::size_t>((m + 1) * (n + 1))), {}};
  net.weights.resize(net.points.size());
  const double spread = uniform(random, 0, 1) < 0.5 ? 0.6 : uniform(random, 0, 6);
  for (Vec3& p : net.points) p = uniform_vector(random, -1, 1);
  for (double& w : net.weights) w = weight(random, spread);
  if (kind == sweep || kind == near_sweep) {
    std::vector<double> rho, of_row;
    for (int j = 0; j <= n; ++j) rho.push_back(uniform(random, 0, 1.5)), of_row.push_back(weight(random, spread / 2));
    if (random() % 3 == 0) rho.back() = 0;
    std::vector<Vec3> e;
    for (int i = 0; i <= m; ++i) e.push_back(uniform_vector(random, -1, 1));
    for (int i = m; i >= 0; --i)
      for (int j = 0; j <= n; ++j) {
        net.point(i, j) = rho[static_cast<std::size_t>(j)] * e[static_cast<std::size_t>(i)] + net.point(0, j);
        net.weight(i, j) = of_row[static_cast<std::size_t>(j)] * net.weight(i, 0);
      }
  }
  if (kind == near_sweep) {
    const double noise = std::pow(10.0, uniform(random, -13, -5));
    for (Vec3& p : net.points) p = p + noise * uniform_vector(random, -1, 1);
    if (random() % 2)
      for (double& w : net.weights) w *= 1 + noise * uniform(random, -1, 1);
  }
  if (kind == flat) {
    const Vec3 a = uniform_vector(random, -1, 1), b = uniform_vector(random, -1, 1), c = uniform_vector(random, -1, 1);
    const double taper = uniform(random, 0.1, 1.5), lift = random() % 2 ? 0 : std::pow(10.0, uniform(random, -12, -3));
    for (int i = 0; i <= m; ++i)
      for (int j = 0; j <= n; ++j) {
        const bool inner = i > 0 && i < m && j > 0 && j < n;
        double u = double(i) / m, v = double(j) / n;
        if (inner) u = uniform(random, 0, 1), v = uniform(random, 0, 1);
        net.point(i, j) = a + u * b + v * c + u * v * (taper - 1) * (b + c) + (inner ? lift : 0) * cross(b, c);
      }
  }
  if (kind == pole)
    for (int i = 1; i <= m; ++i) net.point(i, 0) = net.point(0, 0);
  if (random() % 8 == 0)  // thin patches
    for (Vec3& p : net.points) p.z *= std::pow(10.0, uniform(random, -9, 0)), p.x *= 100;
  return net;
}

BezierPatch patch_of(Net net, const Vec3& shift, double scale, bool turned) {
  for (Vec3& p : net.points) p = scale * p + shift;
  const BezierPatch patch = test::rational(net.m, net.n, net.points, net.weights);
  return turned ? test::transposed(patch) : patch;
}

/// A lower bound on the distance from a point to the patch, and a distance that was found; the search ends if that is
/// at most `enough`. Uses branch and bound over boxes of control points.
test::DistanceRange distance_to_patch(const BezierPatch& patch, const Vec3& p, double enough) {
  struct Piece {
    BezierPatch patch;
    double low;
    bool operator<(const Piece& other) const { return low > other.low; }
  };
  double best = 1e300;
  std::priority_queue<Piece> pieces;
  const auto add = [&](BezierPatch part) {
    const Box3 box = part.hull_box();
    const Vec3 nearest{std::clamp(p.x, box.lower.x, box.upper.x), std::clamp(p.y, box.lower.y, box.upper.y),
                       std::clamp(p.z, box.lower.z, box.upper.z)};
    for (const int i : {0, part.degree_u()})
      for (const int j : {0, part.degree_v()}) best = std::min(best, length(part.point(i, j) - p));
    const double low = length(nearest - p);
    if (low < best) pieces.push({std::move(part), low});
  };
  add(patch);
  for (int step = 0; step < 200000 && !pieces.empty() && best > enough && pieces.top().low < best; ++step) {
    const BezierPatch top = pieces.top().patch;
    pieces.pop();
    const auto halves = test::value_of(split_u(top, 0.5));
    for (const BezierPatch& half : {halves.first, halves.second}) {
      auto quarters = test::value_of(split_v(half, 0.5));
      add(std::move(quarters.first));
      add(std::move(quarters.second));
    }
  }
  return {pieces.empty() ? best : std::min(best, pieces.top().low), best};
}

struct Row {
  std::size_t patches = 0, failed = 0, triangles = 0, points = 0, exceeded = 0, unresolved = 0;
  double nearest = 0;  ///< the largest ratio of distance and bound
};

/// Measures some triangles of one patch.
void measure(const BezierPatch& patch, const Mesh& mesh, std::size_t begin, std::size_t end, double bound,
             Random& random, Row& row) {
  const Box3 box = patch.hull_box();
  const double rounding = 1e-14 * (max_abs(box.lower) + max_abs(box.upper)), most = bound + rounding;
  for (std::size_t k = 0; k < triangles_per_patch && begin < end; ++k) {
    const test::MeshTriangle triangle = test::triangle_of(mesh, begin + random() % (end - begin));
    ++row.triangles;
    for (std::size_t sample = 0; sample < points_per_triangle; ++sample) {
      double share[3] = {uniform(random, 0, 1), uniform(random, 0, 1), sample % 2 ? 0 : uniform(random, 0, 1)};
      const double sum = share[0] + share[1] + share[2];
      double u = 0, v = 0;
      Vec3 on_mesh;
      for (std::size_t c = 0; c < 3; ++c) {
        share[c] /= sum;
        u += share[c] * triangle.parameters[c][0], v += share[c] * triangle.parameters[c][1];
        on_mesh = on_mesh + share[c] * triangle.corners[c];
      }
      const Vec3 on_patch = de_casteljau(patch, std::min(u, 1.0), std::min(v, 1.0));
      const auto to = [&](const test::MeshTriangle& t) {
        return test::distance_to_triangle(on_patch, t.corners[0], t.corners[1], t.corners[2]);
      };
      double there = to(triangle);
      for (std::size_t other = begin; other < end && there > most; ++other)
        there = std::min(there, to(test::triangle_of(mesh, other)));
      test::DistanceRange back{length(on_mesh - on_patch), length(on_mesh - on_patch)};
      if (back.low > most) back = distance_to_patch(patch, on_mesh, most);
      row.points += 2;
      row.exceeded += (there > most) + (back.low > most);
      row.unresolved += back.low <= most && back.high > most;
      if (bound > 0) row.nearest = std::max(row.nearest, (std::max(there, back.low) - rounding) / bound);
    }
  }
}

/// Measures the triangles of each patch, which follow those of the patch before.
void measure_all(const std::vector<BezierPatch>& patches, const std::vector<Kind>& of, const Mesh& mesh,
                 std::span<const float> bounds, Random& random, std::array<Row, kinds>& rows) {
  std::size_t begin = 0;
  for (std::size_t k = 0; k < patches.size(); ++k) {
    std::size_t end = begin;
    while (end < mesh.triangle_count() && mesh.patches[end] == k) ++end;
    measure(patches[k], mesh, begin, end, bounds[k], random, rows[of[k]]);
    begin = end;
  }
}

/// Prints the table, and returns the number of distances that exceed their bound.
std::size_t print(const std::array<Row, kinds>& rows) {
  std::printf("%-16s %9s %9s %10s %10s %9s %10s %14s\n", "kind", "patches", "failed", "triangles", "distances",
              "exceeded", "unresolved", "largest share");
  std::size_t exceeded = 0;
  for (std::size_t k = 0; k < kinds; ++k) {
    const Row& row = rows[k];
    std::printf("%-16s %9zu %9zu %10zu %10zu %9zu %10zu %14.4f\n", names[k], row.patches, row.failed, row.triangles,
                row.points, row.exceeded, row.unresolved, row.nearest);
    exceeded += row.exceeded;
  }
  return exceeded;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1 && (std::string_view(argv[1]) == "--help" || std::string_view(argv[1]) == "-h")) {
    std::fputs(usage, stdout);
    return 0;
  }
  const std::size_t wanted = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 10000;
  if (wanted == 0 || argc > 3) {
    std::fputs(usage, stderr);
    return 2;
  }
  Random random(argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1);
  std::array<Row, kinds> rows;
  std::size_t done = 0;
  for (std::size_t shown = 0; done < wanted;) {
    const int most = random() % 20 == 0 ? 15 : random() % 4 == 0 ? 7 : 3;
    const int m = 1 + static_cast<int>(random() % static_cast<unsigned>(most)),
              n = 1 + static_cast<int>(random() % static_cast<unsigned>(most));
    const double scale = std::pow(10.0, random() % 4 == 0 ? uniform(random, -9, 9) : 0);
    const Vec3 shift =
        (random() % 4 == 0 ? std::pow(10.0, uniform(random, 0, 7)) : 1) * scale * uniform_vector(random, -1, 1);
    std::vector<BezierPatch> patches;
    std::vector<Kind> of;
    for (std::size_t k = 0; k < patches_per_set; ++k) {
      of.push_back(static_cast<Kind>(random() % kinds));
      const bool turned = m == n && random() % 2;
      patches.push_back(patch_of(random_net(random, of.back(), m, n), shift + 3 * scale * uniform_vector(random, -1, 1),
                                 scale, turned));
    }
    const PatchSet set = test::value_of(PatchSet::make(patches));
    const auto plan = Tessellation::make(
        set, {.tolerance = std::pow(10.0, uniform(random, -2.5, -0.5)), .relative = true, .max_triangles = 300000});
    done += patches_per_set;
    for (const Kind kind : of) ++rows[kind].patches, rows[kind].failed += !plan;
    if (!plan) continue;
    Mesh mesh = test::value_of(plan->allocate());
    if (!plan->run(set, mesh.views()).ok()) return 1;
    measure_all(patches, of, mesh, plan->bounds(), random, rows);
    if (done * 10 / wanted != shown)
      std::fprintf(stderr, "%zu of %zu patches\n", done, wanted), shown = done * 10 / wanted;
  }
  return print(rows) == 0 ? 0 : 1;
}
