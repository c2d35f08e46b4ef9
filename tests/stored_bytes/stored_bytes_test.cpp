// Results have the bytes that they had before: hashes.txt stores a hash of each family for AVX2, AVX-512 and NEON,
// which compute the same, and one for SSE2, which rounds products. A hash says that something changed, not that it was
// right.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>

#include "same_bytes/hash.h"
#include "stored_bytes/model_families.h"

namespace {

using tessera::Isa;

const char* const table_file = TESSERA_SOURCE_DIR "/tests/stored_bytes/hashes.txt";
constexpr const char* header =
    "# family, hash by AVX2, AVX-512 and NEON, hash by SSE2 (FNV-1a); see engine/docs/testing.md\n";
constexpr const char* renew =
    "\nIf results are meant to change, store the new hashes and say in the commit why they changed:\n"
    "  TESSERA_RENEW_HASHES=1 build/dev/tests/stored_bytes/tessera_test_stored_bytes";

/// The hashes of a family: [0] by every instruction set with fused multiply-adds, [1] by SSE2.
using Row = std::array<std::string, 2>;
using Table = std::map<std::string, Row>;

std::size_t column(Isa isa) { return isa == Isa::sse2 ? 1 : 0; }

Table read_table() {
  std::ifstream file(table_file);
  Table table;
  for (std::string line, family; std::getline(file, line);) {
    std::istringstream words(line);
    if (line.starts_with('#') || !(words >> family)) continue;
    EXPECT_TRUE(words >> table[family][0] >> table[family][1]) << table_file << ": a row lacks hashes: " << line;
  }
  return table;
}

void write_table(const Table& table) {
  std::ofstream file(table_file);
  file << header;
  for (const auto& [family, row] : table) file << family << ' ' << row[0] << ' ' << row[1] << '\n';
  EXPECT_TRUE(file.flush()) << "cannot write " << table_file;
}

/// The hashes of a family by this machine; "-" in a column of which it has no instruction set.
Row computed(const Family& family) {
  Row row{"-", "-"};
  for (const Isa isa : tessera::available_isas()) {
    std::array<char, 17> hash{};
    std::snprintf(hash.data(), hash.size(), "%016" PRIx64, family.hash(isa));
    std::string& cell = row[column(isa)];
    EXPECT_TRUE(cell == "-" || cell == hash.data())
        << family.name << ": instruction sets with fused multiply-adds differ, " << cell << " and, by " << name(isa)
        << ", " << hash.data();
    cell = hash.data();
  }
  return row;
}

/// Compares with the stored hashes, or stores new ones if TESSERA_RENEW_HASHES is set.
void expect_stored(const std::vector<Family>& families) {
  Table table = read_table();
  const bool renews = std::getenv("TESSERA_RENEW_HASHES") != nullptr;
  for (const Family& family : families) {
    const Row now = computed(family);
    const bool is_stored = table.contains(family.name);
    Row& row = table.try_emplace(family.name, Row{"-", "-"}).first->second;
    for (const std::size_t k : {0u, 1u}) {
      if (now[k] == "-") continue;
      if (renews) row[k] = now[k];
      EXPECT_EQ(row[k], now[k]) << family.name << (k == 0 ? " by AVX2, AVX-512 or NEON" : " by SSE2") << ": "
                                << (is_stored ? "results differ from the stored ones" : "no hash is stored") << renew;
    }
  }
  if (renews) write_table(table);
}

std::vector<Family> synthetic_families() {
  std::vector<Family> families = set_families();
  // Its surfaces need sines and exponentials.
  std::erase_if(families, [](const Family& family) { return family.name == "certified_fits"; });
  // Exact mode. Which facet grid mode meets first is up to Embree.
  families.push_back(ray_families().at(0));
  return families;
}

/// The families of models whose names end in `part`.
std::vector<Family> families_of(const std::string& part) {
  std::vector<Family> families = model_families();
  std::erase_if(families, [&](const Family& family) { return !family.name.ends_with(part); });
  return families;
}

TEST(StoredBytes, SyntheticSets) { expect_stored(synthetic_families()); }
TEST(StoredBytes, GridsOfModels) { expect_stored(families_of(".grid")); }
TEST(StoredBytes, MeshesOfModels) { expect_stored(families_of(".mesh")); }
TEST(StoredBytes, HitsOfModels) { expect_stored(families_of(".hits")); }

/// A row without a family guards nothing.
TEST(StoredBytes, EveryRowHasItsFamily) {
  std::vector<Family> families = synthetic_families();
  for (Family& family : model_families()) families.push_back(std::move(family));
  EXPECT_EQ(read_table().size(), families.size());
  for (const auto& [stored, row] : read_table())
    EXPECT_TRUE(std::ranges::count(families, stored, &Family::name)) << table_file << ": remove the row " << stored;
}

/// One bit of one number changes a hash.
TEST(StoredBytes, AHashSeesEveryBit) {
  const std::vector<float> zeros(100, 0.f);
  for (std::size_t k = 0; k < zeros.size(); ++k) {
    std::vector<float> other = zeros;
    other[k] = -0.f;
    Hash a, b;
    a.add(zeros), b.add(other);
    EXPECT_NE(a.value(), b.value()) << k;
  }
}

}  // namespace
