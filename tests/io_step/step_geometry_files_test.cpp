// Curves and surfaces of all STEP files of the real data: how many convert, by their kinds.

#include <gtest/gtest.h>

#include <array>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <string>

#include "io/step/step_geometry.h"
#include "support/real_files.h"
#include "support/synthetic_sets.h"

namespace tessera::test { namespace {

namespace fs = std::filesystem;

constexpr std::array curve_kinds{"LINE",
                                 "CIRCLE",
                                 "ELLIPSE",
                                 "PARABOLA",
                                 "B_SPLINE_CURVE_WITH_KNOTS",
                                 "RATIONAL_B_SPLINE_CURVE",
                                 "BEZIER_CURVE",
                                 "QUASI_UNIFORM_CURVE",
                                 "UNIFORM_CURVE",
                                 "POLYLINE",
                                 "TRIMMED_CURVE",
                                 "SURFACE_CURVE",
                                 "SEAM_CURVE"};
constexpr std::array surface_kinds{"PLANE",
                                   "CYLINDRICAL_SURFACE",
                                   "CONICAL_SURFACE",
                                   "SPHERICAL_SURFACE",
                                   "TOROIDAL_SURFACE",
                                   "DEGENERATE_TOROIDAL_SURFACE",
                                   "B_SPLINE_SURFACE_WITH_KNOTS",
                                   "RATIONAL_B_SPLINE_SURFACE",
                                   "BEZIER_SURFACE",
                                   "QUASI_UNIFORM_SURFACE",
                                   "SURFACE_OF_LINEAR_EXTRUSION",
                                   "SURFACE_OF_REVOLUTION",
                                   "RECTANGULAR_TRIMMED_SURFACE"};

struct Count {
  std::size_t converted = 0, failed = 0, flat = 0;
};

/// Returns the first of the kinds that the entity has; rational ones have several.
template <std::size_t n>
std::string kind_of(const StepEntity& entity, const std::array<const char*, n>& kinds) {
  if (!entity.status().ok()) return "";
  for (const char* const rational : {"RATIONAL_B_SPLINE_CURVE", "RATIONAL_B_SPLINE_SURFACE"})
    for (const char* const kind : kinds)
      if (std::string(rational) == kind && entity.is(kind)) return kind;
  for (const char* const kind : kinds)
    if (entity.is(kind)) return kind;
  return "";
}

/// Tells whether the text of an error says that an entity has two dimensions, as curves of parameters do.
bool says_flat(const std::string& message) {
  return message.find("expected 3 coordinates, found 2") != std::string::npos ||
         message.find("a placement of the wrong dimension") != std::string::npos;
}

Status converted(const StepGeometry& geometry, std::uint64_t number, bool is_surface) {
  // Unbounded ones, and those whose profile is, get a range.
  if (!is_surface) {
    const Result<StepCurve> all = geometry.curve(number);
    return all || all.status().code() != StatusCode::invalid_argument
               ? all.status()
               : geometry.curve(number, Interval{-1, 2}).status();
  }
  const Result<FaceSurface> all = geometry.surface(number);
  return all || all.status().code() != StatusCode::invalid_argument
             ? all.status()
             : geometry.surface(number, Domain{0, 2, -1, 1}).status();
}

TEST(StepGeometryFiles, CurvesAndSurfacesConvert) {
  const char* const folder = std::getenv("TESSERA_TEST_DATA");
  if (folder == nullptr) GTEST_SKIP() << "TESSERA_TEST_DATA names no folder of real files";
  std::map<std::string, Count> counts;
  std::map<std::string, std::size_t> errors;
  Count all;
  for (const fs::path& path : step_files_below(folder)) {
    if (path.string().find("fault_cases") != std::string::npos) continue;
    std::ifstream file(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    const Result<StepIndex> index = StepIndex::make(text);
    ASSERT_TRUE(index) << index.status().message();
    const StepGeometry geometry(*index), flat(*index, {.dimension = 2});
    StepEntity entity(*index);
    for (const StepInstance& one : index->instances()) {
      entity.read(one.number);
      const std::string curve = kind_of(entity, curve_kinds), surface = kind_of(entity, surface_kinds);
      if (curve.empty() && surface.empty()) continue;
      Status status = converted(geometry, one.number, curve.empty());
      const bool is_flat = !status.ok() && says_flat(status.message());
      if (is_flat) status = converted(flat, one.number, curve.empty());
      for (Count* const count : {&counts[curve + surface], &all})
        ++(status.ok() ? count->converted : count->failed), count->flat += is_flat;
      if (!status.ok() && ++errors[curve + surface] <= 3)
        std::cout << path.filename().string() << ": " << status.message() << '\n';
    }
  }
  for (const auto& [kind, count] : counts)
    std::cout << kind << ": " << count.converted << " converted (" << count.flat << " of two dimensions), "
              << count.failed << " not\n";
  EXPECT_GT(all.converted, 20000u);
  EXPECT_GE(static_cast<double>(all.converted), 0.99 * static_cast<double>(all.converted + all.failed));
}

}}  // namespace tessera::test
