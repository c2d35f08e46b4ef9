// Values that other programs expect: every evaluation of a Bezier, B-spline or NURBS surface in the peers' files,
// points and derivatives, each at its file's own tolerance, by the reference evaluator and through the Bezier patches.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <iostream>

#include "convert/peer_cases.h"
#include "tessera/spline_convert.h"

namespace tessera::test {
namespace {

/// Where the peer errs, or chose what we did not: checked to differ still, and counted apart.
struct KnownDifference {
  const char* surface;
  double u, v;
  const char* what;  ///< "point" or a derivative; empty: all of the surface
  const char* reason;
};
constexpr std::array<KnownDifference, 0> known_differences{};

const KnownDifference* known(const PeerSurface& surface, const PeerEval& eval, const std::string& what) {
  for (const KnownDifference& entry : known_differences)
    if (surface.name == entry.surface && eval.u == entry.u && eval.v == entry.v && what == entry.what) return &entry;
  return nullptr;
}

bool near(const Vec3& value, const Vec3& expected, double tolerance, int dimension) {
  const auto same = [&](double a, double b) { return std::isnan(b) || std::abs(a - b) <= tolerance; };
  return same(value.x, expected.x) && same(value.y, expected.y) && (dimension < 3 || same(value.z, expected.z));
}

Vec3 derivative(const SurfaceJet& jet, const std::string& name) {
  if (name == "du") return jet.du;
  if (name == "dv") return jet.dv;
  if (name == "duu") return jet.duu;
  if (name == "duv") return jet.duv;
  if (name == "dvv") return jet.dvv;
  ADD_FAILURE() << "no derivative " << name;
  return {};
}

struct Count {
  int passed = 0, all = 0, differing = 0;
};

/// Compares one evaluation by one route. A difference that is not in the table fails the test.
bool agrees(const PeerSurface& surface, const PeerEval& eval, const SurfaceJet& jet, const char* route, Count& count) {
  bool good = true;
  const auto compare = [&](const std::string& what, const Vec3& value, const Vec3& expected, double tolerance) {
    if (near(value, expected, tolerance, surface.dimension)) return;
    good = false;
    if (const KnownDifference* entry = known(surface, eval, what)) {
      ++count.differing;
      std::cout << "  differs: " << surface.name << " " << what << ": " << entry->reason << '\n';
      return;
    }
    ADD_FAILURE() << surface.name << " by " << route << " at (" << eval.u << ", " << eval.v << "): " << what << " is ("
                  << value.x << ", " << value.y << ", " << value.z << "), the peer has (" << expected.x << ", "
                  << expected.y << ", " << expected.z << "), tolerance " << tolerance;
  };
  if (eval.point) compare("point", jet.position, *eval.point, eval.point_tolerance);
  if (eval.normal_up_to_sign) {
    const Vec3 normal = normalized(cross(jet.du, jet.dv));
    compare("normal", (dot(normal, *eval.normal_up_to_sign) < 0 ? -1 : 1) * normal, *eval.normal_up_to_sign,
            eval.point_tolerance);
  }
  for (const auto& [name, expected] : eval.derivatives)
    compare(name, derivative(jet, name), expected, name.size() == 2 ? eval.first_tolerance : eval.second_tolerance);
  return good;
}

void run(const PeerSurface& surface, Count& count) {
  count.all += static_cast<int>(surface.evals.size());
  ASSERT_TRUE(surface.surface.ok()) << surface.name << ": " << surface.surface.status().message();
  const Result<PatchGrid> grid = to_bezier(*surface.surface);
  ASSERT_TRUE(grid.ok()) << surface.name << ": " << grid.status().message();
  for (const PeerEval& eval : surface.evals) {
    bool good = agrees(surface, eval, evaluate_jet(*surface.surface, eval.u, eval.v), "de Boor", count);
    const auto jet = grid->evaluate_jet(eval.u, eval.v);
    if (!jet) {
      ADD_FAILURE() << surface.name << ": (" << eval.u << ", " << eval.v << ") is outside";
      continue;
    }
    good = agrees(surface, eval, *jet, "patches", count) && good;
    if (surface.patch) {
      ASSERT_TRUE(surface.patch->ok()) << surface.name;
      good = agrees(surface, eval, evaluate_jet(**surface.patch, eval.u, eval.v), "its own patch", count) && good;
    }
    count.passed += good ? 1 : 0;
  }
}

TEST(PeerCases, Evaluations) {
  const char* data = std::getenv("TESSERA_TEST_DATA");
  if (data == nullptr) GTEST_SKIP() << "TESSERA_TEST_DATA names no folder of test data";
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(data) / "peer_cases"))
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  ASSERT_FALSE(files.empty());
  for (const std::filesystem::path& path : files) {
    const PeerFile file = read_peer_file(data, path);
    Count count;
    for (const PeerSurface& surface : file.surfaces) run(surface, count);
    std::cout << path.stem().string() << " (" << file.peer << "): " << count.passed << " of " << count.all << " passed";
    if (count.differing > 0) std::cout << ", " << count.differing << " known differences";
    std::cout << '\n';
    for (const std::string& entry : file.elsewhere) std::cout << "  not of this test: " << entry << '\n';
  }
}

}  // namespace
}  // namespace tessera::test
