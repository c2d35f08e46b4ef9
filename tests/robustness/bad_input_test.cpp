// Bad input is answered as the table says, and engine/docs/bad-input.md is that table. To write the document anew:
// TESSERA_WRITE_BAD_INPUT=1 tessera_test_robustness --gtest_filter=BadInput.TheDocument

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "robustness/bad_input.h"
#include "support/scratch_folder.h"

namespace tessera::test { namespace {

#ifdef TESSERA_HAS_RAY
constexpr auto rays = fill_rays, batches = fill_batches, queries = fill_queries;
#else
constexpr void (*rays)(Table&) = nullptr;
constexpr auto batches = rays, queries = rays;
#endif
#ifdef TESSERA_HAS_IO
constexpr auto readers = fill_readers, files = fill_files;
#else
constexpr void (*readers)(Table&) = nullptr;
constexpr auto files = readers;
#endif
#ifdef TESSERA_TOOL
constexpr auto commands = fill_commands, model_commands = fill_model_commands;
#else
constexpr void (*commands)(Table&) = nullptr;
constexpr auto model_commands = commands;
#endif

constexpr Section sections[] = {{"Curves", fill_curves},
                                {"Functions as curves and surfaces", fill_callables},
                                {"Bezier and tensor patches", fill_patches},
                                {"B-spline surfaces", fill_splines},
                                {"Hermite patches and networks", fill_hermite},
                                {"Quadrics and explicit polynomials", fill_quadrics},
                                {"Ruled surfaces and Coons patches", fill_borders},
                                {"Trimming loops", fill_trims},
                                {"Operations, conversions, joins", fill_operations},
                                {"Sets and models", fill_sets},
                                {"Shapes and their edges", fill_shapes},
                                {"Areas and volumes", fill_measures},
                                {"Grids", fill_grids},
                                {"Scattered points", fill_points},
                                {"Functions, ruled surfaces and Coons patches on grids", fill_functions},
                                {"Updates", fill_updates},
                                {"Tessellation", fill_tessellations},
                                {"Meshes", fill_meshes},
                                {"Rays", rays},
                                {"Batches of rays", batches},
                                {"Nearest points and points inside", queries},
                                {"Text of files", readers},
                                {"Files", files},
                                {"The machine", fill_machine},
                                {"The command line", commands},
                                {"The command line: models, tables and outputs", model_commands}};

constexpr std::string_view introduction =
    R"(# Bad input

This page shows what comes back from a call that cannot use its input. The tests (`tests/robustness`) make each of these calls and
write the page; they fail if an answer differs from it. The library answers with a `Status`: its code, the index of the
offending element if there is one, and its message. The tests also check that no byte of an output has changed, and that no
file is left behind.

No call ends the program. Three cases are missing, because no library can answer them: memory that does not exist (a `std::span`
or a view that names memory which its owner does not have), objects that have been moved from, and edits of a set while
another thread uses it.
)";

const std::string document = TESSERA_SOURCE_DIR "/engine/docs/bad-input.md";

std::string heading(const Section& section) { return "\n## " + std::string(section.title) + "\n"; }

/// The part of the document below the section's heading.
std::string committed(const std::string& text, const Section& section) {
  const std::size_t begin = text.find(heading(section));
  if (begin == std::string::npos) return {};
  const std::size_t from = begin + heading(section).size(), end = text.find("\n## ", from);
  return text.substr(from, end == std::string::npos ? end : end - from);
}

std::string filled(const Section& section) {
  Table table;
  section.fill(table);
  return table.text();
}

class BadInputSections : public ::testing::TestWithParam<Section> {};

TEST_P(BadInputSections, AreAnsweredAsTheDocumentSays) {
  if (!GetParam().fill) GTEST_SKIP() << "this build has none of it";
  const std::string found = filled(GetParam()), stated = committed(content_of(document), GetParam());
  const auto lines = [](const std::string& text) { return std::count(text.begin(), text.end(), '\n'); };
  EXPECT_GT(lines(found), 4);
  if (found == stated) return;
  const auto [a, b] = std::mismatch(found.begin(), found.end(), stated.begin(), stated.end());
  const auto line_at = [](const std::string& text, std::size_t at) {
    const std::size_t begin = text.rfind('\n', at == 0 ? 0 : at - 1) + 1;
    return text.substr(begin, text.find('\n', at) - begin);
  };
  ADD_FAILURE() << "engine/docs/bad-input.md differs from what the tests get (bad_input_test.cpp says how to write it "
                   "anew).\nthey get: "
                << line_at(found, static_cast<std::size_t>(a - found.begin()))
                << "\nit says:  " << line_at(stated, static_cast<std::size_t>(b - stated.begin()));
}

std::string name_of_section(const ::testing::TestParamInfo<Section>& info) {
  std::string name;
  for (const char c : info.param.title)
    if (std::isalnum(static_cast<unsigned char>(c))) name += c;
  return name;
}

INSTANTIATE_TEST_SUITE_P(BadInput, BadInputSections, ::testing::ValuesIn(sections), name_of_section);

TEST(BadInput, TheDocument) {
  const std::string before = content_of(document);
  if (std::getenv("TESSERA_WRITE_BAD_INPUT")) {
    std::string text(introduction);
    for (const Section& section : sections)
      text += heading(section) + (section.fill ? filled(section) : committed(before, section));
    std::ofstream(document, std::ios::binary) << text;
    return;
  }
  EXPECT_TRUE(before.starts_with(introduction));
  std::string headings, expected;
  for (std::size_t at = before.find("\n## "); at != std::string::npos; at = before.find("\n## ", at + 1))
    headings += before.substr(at, before.find('\n', at + 1) - at);
  for (const Section& section : sections) expected += "\n## " + std::string(section.title);
  EXPECT_EQ(headings, expected);
}

}}  // namespace tessera::test
