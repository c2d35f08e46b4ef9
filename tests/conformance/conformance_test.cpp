// Reads every file of TESSERA_TEST_DATA whole, or gets an error for a reason that its text confirms; compares its
// patches with its surfaces. Prints a table, format by format.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <set>

#include "conformance/census.h"
#include "conformance/patches.h"
#include "support/real_files.h"
#include "support/scratch_folder.h"
#include "tessera/io.h"

namespace tessera::test { namespace {

namespace fs = std::filesystem;

/// Files that are wrong or have no surface, with words that the error must contain.
const std::map<std::string, std::string> refused{
    {"bezierview_bv/SurfLab__cube.bv", "no surface that can be read, but 1 polyhedron"},
    {"bezierview_bv/SurfLab__pawn_1.bv", "no surface that can be read, but 1 polyhedron"},
    {"bezierview_bv/SurfLab__tri1.bv", "no surface that can be read, but 3 triangular patches"},
    {"bezierview_bv/SurfLab__venus.bv", "no surface that can be read, but 1 polyhedron"},
    {"g2_gotools/splipy_cube-8-orient0.g2", "no surface that can be read, but 8 spline volumes"},
    {"g2_gotools/splipy_elementary_curves.g2", "no surface that can be read, but 1 circle, 1 ellipse, 1 line"},
    // Numbers of the page's formula before the data.
    {"obj_freeform_spec/ex1_taylor_curve.obj", ":2: expected a statement"},
    {"obj_freeform_spec/ex2_bezier_curve.obj", "no free-form surface in it"},
    // The line "surf ... \" before this one was lost in print.
    {"obj_freeform_spec/ex3_bspline_surface.obj", ":23: expected a statement (is the line above to be continued"},
    // parm v is all -2.
    {"obj_freeform_spec/ex6_trimmed_nurb_surface.obj", ":26: surface 0: the domain is empty"},
    {"obj_freeform_tests/invalid_bmatrix_missing_step.obj", ":23: surface 0: there is no step for u"},
    {"obj_freeform_tests/invalid_wrong_control_count.obj",
     ":7: surface 0: its parameters and degrees need 3 x 3 control points, found 4"},
};

/// Contents of a file besides the surfaces that are read: words of each warning, in their order.
const std::map<std::string, std::vector<std::string>> warned{
    {"bezierview_bv/SurfLab__tp_poly.bv", {":14: 2 polyhedra are not read"}},
    {"g2_gotools/splipy_elementary_surfaces.g2", {":22: 1 disc is not read"}},
    {"obj_freeform_spec/ex4_cardinal_surface.obj", {":20: 1 statement is not kept, the first here: 1 stech"}},
    {"obj_freeform_spec/ex5_rational_bspline_surface.obj", {":11: 9 statements are not kept, the first here: 9 vt"}},
    {"obj_freeform_tests/bezier_negative_slash_refs.obj", {":5: 4 statements are not kept, the first here: 4 vt"}},
    {"classic_teaset/uteapot.rib", {"requests that are skipped"}},
    {"rib_aqsis/autoshadow.rib", {"requests that are skipped"}},
    {"rib_aqsis/mb_noise_test.rib", {"first moment only, 1 other", "requests that are skipped"}},
    {"rib_aqsis/tenpatch.rib", {"requests that are skipped"}},
    {"rib_aqsis/vase.rib", {":23: 3 worlds share one space", "requests that are skipped"}},
    // Offset surfaces.
    {"iges_nist_benchmarks/140-000.igs", {"1 surface fitted by splines"}},
    // D171 is a conic, not a surface.
    {"iges_nist_benchmarks/nentity.igs", {"OpenCASCADE: D171", "1 surface fitted"}},
};

/// A row of the table at the end.
struct Row {
  std::size_t files = 0, read = 0, surfaces = 0, patches = 0, warnings = 0, refused = 0;
};

const std::set<std::string> text_formats{".bpt", ".bv", ".g2", ".obj", ".rib"};

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// The row of a file: the name of its format, or of another group.
std::string row_of(const fs::path& file, const std::string& folder) {
  const std::string extension = lower(file.extension().string());
  if (extension == ".txt" || extension == ".md") return "words about the data";
  if (folder == "peer_cases") return "values of other programs";
  if (extension == ".stp" || extension == ".step") return ".step";
  if (extension == ".igs" || extension == ".iges") return ".iges";
  if (extension == ".brep") return ".brep";
  return text_formats.contains(extension) ? extension : "no reader: " + extension;
}

class Conformance : public testing::Test {
 protected:
  void SetUp() override {
    const char* const data = std::getenv("TESSERA_TEST_DATA");
    if (!data) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
    data_ = data;
    for (const fs::path& file : files_below(data_)) files_.insert(fs::relative(file, data_));
    ASSERT_FALSE(files_.empty()) << data_;
  }

  void visit(const fs::path& file);
  void expect_refused(const std::string& name, const std::string& message, std::size_t stated);
  void expect_read(const std::string& name, const Model& model, std::size_t stated, Row& row);

  fs::path data_;
  std::set<fs::path> files_;
  std::map<std::string, Row> table_;
  PatchFigures all_;
};

std::size_t stated_in(const fs::path& path, const std::string& format) {
  if (format == ".step") return step_faces(content_of(path));
  if (format == ".iges") return iges_surfaces(content_of(path));
  if (format == ".brep") return brep_faces(content_of(path));
  return surfaces_stated(path);
}

void Conformance::visit(const fs::path& file) {
  const std::string name = file.string(), format = row_of(file, file.begin()->string());
  Row& row = table_[format];
  ++row.files;
  if (format == "words about the data" || format == "values of other programs") return;
  const fs::path path = data_ / file;
  const Result<Model> model = read_model(path);
  const auto without_path = [&](const std::string& text) {
    EXPECT_EQ(text.find(path.string() + ":"), 0u) << text;
    return text.substr(std::min(path.string().size(), text.size()));
  };
  if (!model && model.status().code() == StatusCode::unsupported &&
      model.status().message().find("unsupported format") != std::string::npos) {
    EXPECT_TRUE(format.starts_with("no reader")) << name;
    return;
  }
  const std::size_t stated = stated_in(path, format);
  if (model) {
    expect_read(name, *model, stated, row);
    std::printf("  %-62s %4zu %s, warnings: %zu\n", name.c_str(), model->surfaces.size(),
                std::string(kind_name(model->surfaces.front().surface)).c_str(), model->warnings.size());
    for (const std::string& warning : model->warnings) std::printf("      %s\n", without_path(warning).c_str());
  } else {
    ++row.refused;
    const std::string reason = without_path(model.status().message());
    expect_refused(name, reason, stated);
    std::printf("  %-62s refused%s\n", name.c_str(), reason.c_str());
  }
}

void Conformance::expect_refused(const std::string& name, const std::string& message, std::size_t stated) {
  const auto reason = refused.find(name);
  if (reason != refused.end()) {
    EXPECT_NE(message.find(reason->second), std::string::npos) << name << message;
    return;
  }
  // All others must be free of surfaces by their own directory.
  EXPECT_EQ(stated, 0u) << name << message;
  EXPECT_NE(message.find("it holds no surfaces"), std::string::npos) << name << message;
}

void Conformance::expect_read(const std::string& name, const Model& model, std::size_t stated, Row& row) {
  EXPECT_FALSE(refused.contains(name));
  EXPECT_EQ(model.surfaces.size(), stated) << name;
  const PatchFigures figures = expect_patches_follow_surfaces(model);
  ++row.read;
  row.surfaces += model.surfaces.size();
  row.patches += figures.patches;
  row.warnings += model.warnings.size();
  all_.points += figures.points;
  all_.double_error = std::max(all_.double_error, figures.double_error);
  all_.float_error = std::max(all_.float_error, figures.float_error);
  const auto wanted = warned.find(name);
  if (wanted != warned.end()) {
    EXPECT_EQ(model.warnings.size(), wanted->second.size()) << name;
    for (std::size_t k = 0; k < std::min(model.warnings.size(), wanted->second.size()); ++k)
      EXPECT_NE(model.warnings[k].find(wanted->second[k]), std::string::npos) << model.warnings[k];
    return;
  }
  EXPECT_TRUE(model.warnings.empty()) << name << ": " << model.warnings.front();
}

TEST_F(Conformance, EveryFileIsReadWholeOrRefusedForItsReason) {
  for (const fs::path& file : files_) visit(file);
  std::printf("\n%-28s %6s %6s %9s %9s %9s %8s\n", "format", "files", "read", "surfaces", "patches", "warnings",
              "refused");
  Row sum;
  for (const auto& [format, row] : table_) {
    std::printf("%-28s %6zu %6zu %9zu %9zu %9zu %8zu\n", format.c_str(), row.files, row.read, row.surfaces, row.patches,
                row.warnings, row.refused);
    sum.files += row.files, sum.read += row.read, sum.surfaces += row.surfaces, sum.patches += row.patches;
    sum.warnings += row.warnings, sum.refused += row.refused;
  }
  std::printf("%-28s %6zu %6zu %9zu %9zu %9zu %8zu\n", "all", sum.files, sum.read, sum.surfaces, sum.patches,
              sum.warnings, sum.refused);
  std::printf(
      "%zu points of the patches lie on their surfaces to %.1f units of 2^-52 of their size, by the float kernels to "
      "%.1f of 2^-23\n",
      all_.points, all_.double_error, all_.float_error);
#ifdef TESSERA_HAS_CAD_READER
  EXPECT_GE(sum.read, 60u);
#else
  std::printf("STEP and IGES are not read: OpenCASCADE was not there when this was built\n");
#endif
}

}}  // namespace tessera::test
