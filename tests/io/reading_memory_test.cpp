// The most memory that reading a file takes: the peak of operator new, the file's own bytes included, over the file's
// size. Reads the files of TESSERA_TEST_DATA, and large ones of each format: as programs write them, with seven digits,
// and as terse as the format permits, with one digit per number.

#include <array>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <set>

#include "io/obj_samples.h"
#include "support/allocations.h"
#include "support/real_files.h"
#include "support/scratch_folder.h"

namespace tessera::test { namespace {

namespace fs = std::filesystem;
using Parser = Result<Model> (*)(std::string_view, std::string_view);

/// Memory that does not grow with the file: tables of names, the first array of points, the messages.
constexpr std::size_t constant = std::size_t{64} << 10;

/// The text's own bytes count too: read_model() holds them.
double factor_of(const std::string& text, Parser parse) {
  const std::size_t before = restart_peak();
  const Result<Model> model = parse(text, "m");
  const std::size_t peak = peak_bytes() - before;
  EXPECT_TRUE(model.ok()) << model.status().message();
  return 1 + static_cast<double>(peak - std::min(peak, constant)) / static_cast<double>(text.size());
}

TEST(ReadingMemory, RealFilesTakeAtMostEightTimesTheirSize) {
  const char* const data = std::getenv("TESSERA_TEST_DATA");
  if (!data) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  const std::set<std::string> ours{".bpt", ".bv", ".g2", ".json", ".obj", ".rib"};
  struct Worst {
    std::size_t files = 0;
    double factor = 0;
    std::string name;
  };
  std::map<std::string, Worst> worst;
  for (const fs::path& path : files_below(data)) {
    if (!ours.contains(path.extension())) continue;
    const std::size_t before = restart_peak();
    const Result<Model> model = read_model(path);
    const std::size_t peak = peak_bytes() - before;
    EXPECT_LE(peak, 8 * fs::file_size(path) + constant) << path;
    Worst& of_kind = worst[path.extension()];
    ++of_kind.files;
    const double factor = static_cast<double>(peak) / static_cast<double>(fs::file_size(path));
    if (fs::file_size(path) > constant / 8 && factor > of_kind.factor) {
      of_kind.factor = factor;
      of_kind.name = path.filename();
    }
  }
  EXPECT_GE(worst.size(), 5u);
  for (const auto& [extension, of_kind] : worst) {
    std::cout << "  " << extension << ": " << of_kind.files << " files";
    if (of_kind.factor > 0) std::cout << ", at most " << of_kind.factor << " times the file (" << of_kind.name << ")";
    std::cout << '\n';
  }
}

// Large files.

/// `points` numbered points, one per line of text. Seven digits are what programs write.
std::string points_text(std::size_t points, bool terse, std::string_view begin = "", std::string_view weight = "") {
  Random random(12);
  const std::vector<Vec3> cloud = random_cloud(random, points);
  std::string text;
  for (std::size_t k = 0; k < points; ++k) {
    text += begin;
    const Vec3& p = cloud[k];
    if (terse)
      text += std::to_string(k % 10) + " 0 1";
    else
      text += std::to_string(p.x) + ' ' + std::to_string(p.y) + ' ' + std::to_string(p.z);
    if (!weight.empty()) text += k % 2 == 0 ? " 1" : weight;
    text += '\n';
  }
  return text;
}

std::string repeated(const std::string& text, std::size_t times) {
  std::string all;
  for (std::size_t k = 0; k < times; ++k) all += text;
  return all;
}

std::string whole_knots(std::size_t count) {
  std::string text;
  for (std::size_t k = 0; k < count; ++k) text += " " + std::to_string(k);
  return text;
}

/// Patches of degree n x n.
std::string bpt_text(int n, std::size_t patches, bool terse) {
  const std::string degree = std::to_string(n),
                    points = points_text(static_cast<std::size_t>((n + 1) * (n + 1)), terse);
  return std::to_string(patches) + "\n" + repeated(degree + " " + degree + "\n" + points, patches);
}

std::string bv_text(std::size_t patches, bool terse) {
  return "group 0 " + std::string(200, 'x') + "\n" + repeated("4 1\n" + points_text(4, terse), patches) +
         repeated("8 1 1\n" + points_text(4, terse, "", " 2"), patches);
}

/// Bilinear, of n x n points.
std::string g2_text(std::size_t n, std::size_t surfaces, bool terse, bool rational = false) {
  const std::string line = std::to_string(n) + " 2\n0" + whole_knots(n) + " " + std::to_string(n - 1) + "\n";
  return repeated(std::string("200 1 0 0\n3 ") + (rational ? "1\n" : "0\n") + line + line +
                      points_text(n * n, terse, "", rational ? " 2" : ""),
                  surfaces);
}

std::string rib_patches(std::size_t patches, bool terse) {
  return "Attribute \"identifier\" \"name\" \"" + std::string(100, 'x') + "\"\nTranslate 1 2 3\n" +
         repeated("Patch \"bilinear\" \"P\"[" + points_text(4, terse) + "]\n", patches);
}

std::string rib_mesh(const std::string& basis, std::size_t n, bool terse) {
  const std::string size = std::to_string(n) + " \"nonperiodic\" ";
  return "Basis \"" + basis + "\" 1 \"" + basis + "\" 1\nPatchMesh \"bicubic\" " + size + size + "\"P\" [" +
         points_text(n * n, terse) + "]\n";
}

std::string obj_mesh(std::size_t n, std::size_t surfaces, bool terse) {
  std::string text;
  for (std::size_t k = 0; k < surfaces; ++k)
    text += points_text(n * n, terse, "v ") + "cstype bspline\ndeg 3 3\nsurf 3 " + std::to_string(n) + " 3 " +
            std::to_string(n) + range_text(n * n, k * n * n + 1) + "\nparm u" + whole_knots(n + 4) + "\nparm v" +
            whole_knots(n + 4) + "\nend\n";
  return text;
}

/// Every patch has the same four vertices.
std::string obj_shared(std::size_t patches) {
  return four_vertices + "g " + std::string(200, 'x') + "\ncstype bezier\ndeg 1 1\n" +
         repeated("surf 0 1 0 1 1 2 3 4\nparm u 0 1\nparm v 0 1\nend\n", patches);
}

/// One surface of n x n times the same point.
std::string obj_indices(std::size_t n) {
  const std::string knots = " 0" + whole_knots(n) + " " + std::to_string(n - 1);
  return four_vertices + "cstype bspline\ndeg 1 1\nsurf 0 1 0 1" + repeated(" 1", n * n) + "\nparm u" + knots +
         "\nparm v" + knots + "\nend\n";
}

std::string json_patches(std::size_t patches, bool terse) {
  std::string rows;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      rows += j > 0 ? "," : i > 0 ? ",[" : "[";
      rows += terse ? "[1,0,0]" : "[ 1.234567, 0.765432, -3.141593 ]\n";
      if (j == 3) rows += "]";
    }
  std::string text = R"({"format":"tessera","version":1,"surfaces":[)";
  for (std::size_t k = 0; k < patches; ++k)
    text += (k > 0 ? "," : "") + (R"({"kind":"bezier","points":[)" + rows) + "]}";
  return text + "]}";
}

struct Large {
  std::string name;
  std::string text;
  Parser parse;
  double limit = 8;
};

TEST(ReadingMemory, LargeFilesAsProgramsWriteThem) {
  const std::vector<Large> files{
      {"bpt, bilinear", bpt_text(1, 8000, false), parse_bpt},
      {"bpt, bicubic", bpt_text(3, 2000, false), parse_bpt},
      {"bv", bv_text(4000, false), parse_bv},
      {"g2, many", g2_text(4, 1000, false), parse_g2},
      {"g2, one", g2_text(150, 1, false), parse_g2},
      {"g2, rational", g2_text(150, 1, false, true), parse_g2},
      {"json", json_patches(1000, false), parse_json_model},
      {"obj, splines", obj_mesh(64, 8, false), parse_obj_freeform},
      {"obj, small splines", obj_mesh(4, 1000, false), parse_obj_freeform},
      {"rib, patches", rib_patches(4000, false), parse_rib},
      {"rib, B-spline mesh", rib_mesh("b-spline", 150, false), parse_rib},
      {"rib, Catmull-Rom mesh", rib_mesh("catmull-rom", 150, false), parse_rib},
  };
  for (const Large& file : files) {
    const double factor = factor_of(file.text, file.parse);
    std::cout << "  " << file.name << ": " << factor << " times " << file.text.size() << " bytes\n";
    EXPECT_LE(factor, file.limit) << file.name;
  }
}

// A digit and a blank become 8 bytes, as tessera/io.h says.
TEST(ReadingMemory, TheTersestFiles) {
  const std::vector<Large> files{
      {"bpt, bilinear", bpt_text(1, 40000, true), parse_bpt},
      {"bpt, bicubic", bpt_text(3, 10000, true), parse_bpt},
      {"bv", bv_text(20000, true), parse_bv},
      {"g2, many", g2_text(2, 10000, true), parse_g2, 10},
      {"g2, one", g2_text(400, 1, true), parse_g2},
      {"g2, rational", g2_text(400, 1, true, true), parse_g2},
      {"json", json_patches(5000, true), parse_json_model, 14},
      {"obj, splines", obj_mesh(64, 8, true), parse_obj_freeform},
      {"obj, patches of the same points", obj_shared(20000), parse_obj_freeform, 10},
      {"obj, one point named again", obj_indices(400), parse_obj_freeform, 17},
      {"rib, patches", rib_patches(20000, true), parse_rib},
      {"rib, B-spline mesh", rib_mesh("b-spline", 400, true), parse_rib, 12},
      {"rib, Catmull-Rom mesh", rib_mesh("catmull-rom", 400, true), parse_rib, 29},
  };
  for (const Large& file : files) {
    const double factor = factor_of(file.text, file.parse);
    std::cout << "  " << file.name << ": " << factor << " times " << file.text.size() << " bytes\n";
    EXPECT_LE(factor, file.limit) << file.name;
  }
}

}}  // namespace tessera::test
