// Part of each program whose tests run with every instruction set: the kernels state which set ran.

#include <gtest/gtest.h>

#include "support/grids.h"
#include "tessera/tessellation.h"

namespace tessera::test { namespace {

TEST(SuiteIsa, RunsGridsAndMeshes) {
  const char* const forced = std::getenv("TESSERA_ISA");
  const bool is_forced = forced && *forced;
  const std::string wanted(is_forced ? forced : name(available_isas().back()));
  const PatchSet set = set_of(wavy_field(2, 2));
  ExecutionReport report;
  Execution execution;
  execution.report = &report;

  const std::vector<double> t = uniform_parameters(5);
  const GridPlan grid = value_of(GridPlan::make(set, t, t));
  GridBuffers<float> out(grid);
  ASSERT_TRUE(evaluate(set, grid, out.views(), execution).ok());
  EXPECT_EQ(name(report.isa), wanted);

  report = {};
  const auto plan = value_of(Tessellation::make(set, {.tolerance = 1e-2}));
  Mesh mesh = value_of(plan.allocate());
  ASSERT_TRUE(plan.run(set, mesh.views(), execution).ok());
  EXPECT_EQ(name(report.isa), wanted);
}

}}  // namespace tessera::test
