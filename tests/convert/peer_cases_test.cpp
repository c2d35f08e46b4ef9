// Compares with values of other programs: every value of a surface in the peers' files, points and derivatives, each at
// its file's own tolerance, by the reference evaluator and through the Bezier patches.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <iostream>

#include "convert/peer_cases.h"

namespace tessera::test { namespace {

/// Cases where the peer errs, or chose another convention: checked to differ still, and counted apart.
struct KnownDifference {
  const char* surface;
  double u, v;
  const char* what;  ///< "point", "normal" or a derivative
  const char* reason;
};
constexpr std::array<KnownDifference, 0> known_differences{};

const KnownDifference* known(const PeerCase& peer, const PeerEval& eval, const std::string& what) {
  for (const KnownDifference& entry : known_differences)
    if (peer.surface.name == entry.surface && eval.u == entry.u && eval.v == entry.v && what == entry.what)
      return &entry;
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
  std::size_t passed = 0, differing = 0, all = 0;
};

/// How one evaluation compares.
struct Verdict {
  bool good = true;
  bool differs = false;  ///< as the table says
};

/// Compares by one route. Exactly the cases of the table must differ.
void compare(const PeerCase& peer, const PeerEval& eval, const Route& route, Verdict& verdict) {
  const auto jet = route.jet(eval.u, eval.v);
  const auto expect = [&](const std::string& what, const Vec3& value, const Vec3& expected, double tolerance) {
    const bool same = near(value, expected, tolerance, peer.surface.dimension);
    const KnownDifference* entry = known(peer, eval, what);
    verdict.differs = verdict.differs || entry != nullptr;
    if (same == (entry == nullptr)) return;
    verdict.good = false;
    ADD_FAILURE() << peer.surface.name << " by " << route.name << " at (" << eval.u << ", " << eval.v << "): " << what
                  << " is (" << value.x << ", " << value.y << ", " << value.z << "), the peer has (" << expected.x
                  << ", " << expected.y << ", " << expected.z << "), tolerance " << tolerance
                  << (entry != nullptr ? ": it no longer differs" : "");
  };
  if (!jet) {
    verdict.good = false;
    ADD_FAILURE() << peer.surface.name << " by " << route.name << ": (" << eval.u << ", " << eval.v << ") is outside";
    return;
  }
  if (eval.point) expect("point", jet->position, *eval.point, eval.point_tolerance);
  if (eval.normal_up_to_sign) {
    const Vec3 normal = normalized(cross(jet->du, jet->dv));
    expect("normal", (dot(normal, *eval.normal_up_to_sign) < 0 ? -1 : 1) * normal, *eval.normal_up_to_sign,
           eval.point_tolerance);
  }
  for (const auto& [name, expected] : eval.derivatives)
    expect(name, derivative(*jet, name), expected, name.size() == 2 ? eval.first_tolerance : eval.second_tolerance);
}

void run(const PeerCase& peer, Count& count) {
  count.all += peer.evals.size();
  ASSERT_TRUE(peer.surface.status.ok()) << peer.surface.name << ": " << peer.surface.status.message();
  ASSERT_GE(peer.surface.routes.size(), 2u);
  for (const PeerEval& eval : peer.evals) {
    Verdict verdict;
    for (const Route& route : peer.surface.routes) compare(peer, eval, route, verdict);
    count.passed += verdict.good && !verdict.differs ? 1 : 0;
    count.differing += verdict.differs ? 1 : 0;
  }
}

std::size_t run(const PeerFile& file, const std::string& name) {
  Count count;
  for (const PeerCase& peer : file.cases) run(peer, count);
  std::cout << name << ": " << count.passed << " of " << count.all << " values on " << file.cases.size()
            << " surfaces passed";
  if (file.rays > 0) std::cout << " (the hits of " << file.rays << " rays)";
  std::cout << "; " << file.peer << '\n';
  if (count.differing > 0) std::cout << "  " << count.differing << " differ, for the reasons below\n";
  for (const PeerSurface& surface : file.invalid) {
    EXPECT_FALSE(surface.status.ok()) << surface.name << ": the peer refuses it";
    std::cout << "  refused, as by the peer: " << surface.name << ": " << surface.status.message() << '\n';
  }
  for (const std::string& entry : file.elsewhere) std::cout << "  not of this test: " << entry << '\n';
  return count.all;
}

TEST(PeerCases, Evaluations) {
  const char* data = std::getenv("TESSERA_TEST_DATA");
  if (data == nullptr) GTEST_SKIP() << "TESSERA_TEST_DATA names no folder of test data";
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(data) / "peer_cases"))
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  ASSERT_FALSE(files.empty());
  std::size_t values = 0;
  for (const std::filesystem::path& path : files) values += run(read_peer_file(data, path), path.stem());
  EXPECT_GE(values, 754u);  // as many as there were when this was written
  for (const KnownDifference& entry : known_differences)
    std::cout << "differs: " << entry.surface << " at (" << entry.u << ", " << entry.v << ") " << entry.what << ": "
              << entry.reason << '\n';
}

}}  // namespace tessera::test
