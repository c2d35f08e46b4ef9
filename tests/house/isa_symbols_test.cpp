// The units of one instruction set each leave no function behind that the rest of the program could get by mistake.

#include "house/isa_symbols.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <memory>

namespace tessera::house {
namespace {

TEST(IsaSymbols, ForeignFunctionsAreFound) {
  const auto unit = isa_unit_of("/build/kernel.dir/src/kernel/isa_avx512.cpp.o");
  ASSERT_TRUE(unit);
  const std::string own =
      "0000000000000000 T tessera::kernel::avx512_kernels()\n"
      "0000000000000010 W void tessera::kernel::isa_avx512::grid<3>(float const*)\n"
      "0000000000000020 W xsimd::batch<float, xsimd::avx512bw>::batch(float)\n"
      "0000000000000030 t tessera::kernel::hidden()\n"
      "0000000000000040 V typeinfo for std::exception\n"
      "0000000000000050 r tessera::kernel::table\n";
  EXPECT_EQ(foreign_functions(*unit, own), std::vector<std::string>());
  const std::array foreign{
      "std::vector<float, std::allocator<float> >::~vector()",
      "tessera::name(tessera::Isa)",
      "tessera::kernel::avx2_kernels()",
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
  EXPECT_EQ(isa_unit_of("src/kernel/isa_avx2_fma.cpp.o")->isa, "avx2");
  EXPECT_EQ(isa_unit_of("src/kernel/isa_sse2.cpp.o")->isa, "sse2");
  EXPECT_EQ(isa_unit_of("src/kernel/isa_neon64.cpp.o")->isa, "neon64");
  EXPECT_FALSE(isa_unit_of("src/kernel/select_isa.cpp.o"));
}

std::string output_of(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), [](FILE* f) { return pclose(f); });
  std::string output;
  std::array<char, 4096> buffer;
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe.get())) {
    output.append(buffer.data(), count);
  }
  return output;
}

TEST(IsaSymbols, ObjectsHoldOnlyTheirOwn) {
  std::ifstream list(TESSERA_KERNEL_OBJECTS);
  int units = 0;
  for (std::string object; std::getline(list, object);) {
    const auto unit = isa_unit_of(object);
    if (!unit) {
      EXPECT_EQ(object.find("/isa_"), std::string::npos) << object << " is a unit that this test does not know";
      continue;
    }
    ++units;
    const std::string listing = output_of("'" TESSERA_NM "' -C --defined-only '" + object + "'");
    EXPECT_NE(listing.find(" T tessera::kernel::" + std::string(unit->isa) + "_kernels()"), std::string::npos)
        << object << ": no table of kernels in what nm prints:\n"
        << listing;
    for (const std::string& symbol : foreign_functions(*unit, listing)) ADD_FAILURE() << object << " holds " << symbol;
  }
  EXPECT_EQ(units, 3);
}

}  // namespace
}  // namespace tessera::house
