// Shapes in memory beside the files that hold them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "io/cad/model_bytes.h"
#include "io_occt/cad_shapes.h"
#include "occt/map_checks.h"
#include "occt/occt_shapes.h"
#include "support/real_files.h"
#include "support/scratch_folder.h"
#include "tessera/occt.h"

namespace tessera::test { namespace {

/// The message or warning without the path that it begins with, and without the unit of BREP, which has none.
std::string without_path(std::string text, const std::string& path) {
  if (text.starts_with(path + ": ")) text.erase(0, path.size() + 2);
  if (text.ends_with(" mm")) text.erase(text.size() - 3);
  return text;
}

/// Expects the model of a BREP file of the shape to be the one of the shape that OpenCASCADE reads in it, bit for bit.
/// That is not the shape itself: the reader divides directions by their length again.
void expect_model_of_file(const TopoDS_Shape& shape, const std::string& path, const std::string& name) {
  write_cad(shape, path);
  const Result<DescribedShape> file = load_cad(path);
  ASSERT_TRUE(file.ok()) << name;
  const Result<OcctModel> here = model_from(file->shape);
  Result<Model> read = read_by_opencascade(path);
  ASSERT_EQ(here.ok(), read.ok()) << name << here.status().message() << read.status().message();
  if (!read) {
    if (here.status().code() == StatusCode::invalid_argument) return;  // no faces: the file's error has other words
    EXPECT_EQ(here.status().code(), read.status().code()) << name;
    EXPECT_EQ(here.status().message(), without_path(read.status().message(), path)) << name;
    return;
  }
  read->name.clear();  // of the file
  for (std::string& warning : read->warnings) warning = without_path(warning, path);
  EXPECT_TRUE(to_bytes(here->model) == to_bytes(read)) << name;
}

TEST(ShapesInMemory, GiveTheModelsOfTheirFiles) {
  const ScratchFolder folder;
  for (const NamedShape& one : occt_shapes()) {
    if (one.name.find("location") != std::string::npos) continue;  // OpenCASCADE writes no files with scales in places
    expect_model_of_file(one.shape, folder / "one.binary.brep", one.name);
  }
}

/// The largest distance that warnings state of a fit, with room for its rounding: "... to within 0.02 mm".
double stated_fit(const Model& model) {
  double fit = 0;
  for (const std::string& warning : model.warnings)
    if (const std::size_t at = warning.rfind("to within "); at != std::string::npos)
      fit = std::max(fit, 1.5 * std::stod(warning.substr(at + 10)));
  return fit;
}

TEST(ShapesInMemory, OfRealFilesGiveTheModelsOfTheirFilesAndMapBack) {
  const char* const data = std::getenv("TESSERA_TEST_DATA");
  if (!data) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  std::vector<std::filesystem::path> files = step_files_below(data);  // cad_corpus too
  for (const std::filesystem::path& path : real_cad_files())
    if (std::ranges::find(files, path) == files.end()) files.push_back(path);
  const ScratchFolder folder;
  int points = 0;
  for (const std::filesystem::path& path : files) {
    if (std::filesystem::file_size(path) > 3000000) continue;
    if (read_by_opencascade(path).status().code() == StatusCode::internal) continue;  // OpenCASCADE crashes
    const Result<DescribedShape> file = load_cad(path.string());
    if (!file || file->shape.IsNull()) continue;
    expect_model_of_file(file->shape, folder / "one.binary.brep", path.string());
    const Result<OcctModel> here = model_from(file->shape);
    if (here) points += expect_mapped(*here, file->shape, path.string(), stated_fit(here->model));
  }
  EXPECT_GT(points, 100000);
}

}}  // namespace tessera::test
