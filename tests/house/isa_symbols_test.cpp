// The units of one instruction set contain no function that the rest of the program could use by mistake.

#include "house/isa_symbols.h"

#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <map>
#include <regex>

#include "house/output_of.h"

namespace tessera::house { namespace {

TEST(IsaSymbols, ForeignFunctionsAreFound) {
  const auto unit = isa_unit_of("/build/tessera_kernel_avx512.dir/src/kernel/grid/unit_grid.cpp.o");
  ASSERT_TRUE(unit);
  const std::string own =
      "0000000000000000 T tessera::kernel::isa_avx512::kernels()\n"
      "0000000000000010 W void tessera::kernel::isa_avx512::grid<3>(float const*)\n"
      "0000000000000020 W xsimd::batch<float, xsimd::avx512bw>::batch(float)\n"
      "0000000000000030 t tessera::kernel::hidden()\n"
      "0000000000000040 V typeinfo for std::exception\n"
      "0000000000000050 r tessera::kernel::table\n";
  EXPECT_EQ(foreign_functions(*unit, own), std::vector<std::string>());
  const std::array foreign{
      "std::vector<float, std::allocator<float> >::~vector()",
      "tessera::name(tessera::Isa)",
      "tessera::kernel::kernels(tessera::Isa)",
      "tessera::kernel::isa_avx2::grid()",
      "xsimd::batch<float, xsimd::avx2>::batch(float)",
      "tessera::kernel::isa_avx512::cast(xsimd::batch<float, xsimd::sse2>)",
      "std::max(float const&, float const&)",
  };
  for (const char* symbol : foreign) {
    for (const char* type : {"T", "W"}) {
      const std::string listing = own + "00000000000000ff " + type + " " + symbol + "\n";
      EXPECT_EQ(foreign_functions(*unit, listing), std::vector<std::string>{symbol});
    }
  }
}

TEST(IsaSymbols, UnitsAreKnownByTheirObjects) {
  EXPECT_EQ(isa_unit_of("engine/CMakeFiles/tessera_kernel_avx2.dir/src/kernel/grid/unit_grid.cpp.o")->isa, "avx2");
  EXPECT_EQ(isa_unit_of("engine/CMakeFiles/tessera_kernel_sse2.dir/src/kernel/net/unit_net.cpp.o")->isa, "sse2");
  EXPECT_EQ(isa_unit_of("engine/CMakeFiles/tessera_kernel_neon64.dir/src/kernel/net/unit_net.cpp.o")->isa, "neon64");
  EXPECT_EQ(isa_unit_of("engine/CMakeFiles/tessera_kernel_sse2_mesh.dir/src/kernel/mesh/unit_mesh.cpp.o")->isa, "sse2");
  EXPECT_FALSE(isa_unit_of("engine/CMakeFiles/tessera_kernel.dir/src/kernel/table/select_isa.cpp.o"));
}

TEST(IsaSymbols, ObjectsHoldOnlyTheirOwn) {
  std::ifstream list(TESSERA_OBJECTS);
  std::map<std::string_view, int> units;
  for (std::string object; std::getline(list, object);) {
    const auto unit = isa_unit_of(object);
    if (!unit) {
      EXPECT_EQ(object.find("/tessera_kernel_"), std::string::npos)
          << object << " is a unit that this test does not know";
      continue;
    }
    ++units[unit->isa];
    const std::string listing = output_of("'" TESSERA_NM "' -C --defined-only '" + object + "'");
    EXPECT_TRUE(std::regex_search(
        listing, std::regex(" [DR] tessera::\\w+::kernel::isa_" + std::string(unit->isa) + "::[a-z_]+_kernels\n")))
        << object << ": no table of kernels in what nm prints:\n"
        << listing;
    for (const std::string& symbol : foreign_functions(*unit, listing)) ADD_FAILURE() << object << " holds " << symbol;
  }
  EXPECT_EQ(units.size(), 3u);
  for (const auto& [isa, count] : units) EXPECT_EQ(count, units.begin()->second) << isa;
}

}}  // namespace tessera::house
