// Faults of the file system, of editors and of locales that the readers of STEP and IGES must bear or report.

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <opencascade/BRepPrimAPI_MakeTorus.hxx>

#include "io_occt/cad_shapes.h"
#include "support/comma_locale.h"
#include "support/errors.h"
#include "support/privileges.h"
#include "support/scratch_folder.h"
#include "tessera/cad.h"

namespace tessera::test { namespace {

class BadCadFile : public testing::TestWithParam<const char*> {
 protected:
  BadCadFile() {
    write_cad(BRepPrimAPI_MakeTorus(5.25, 1.5).Shape(), folder_ / name("torus"));
    text_ = content_of(folder_ / name("torus"));
  }
  std::string name(const std::string& stem) const { return stem + GetParam(); }
  /// Some points of the torus as read from this text, or no number and a failure.
  std::vector<Vec3> points_of(const std::string& text, const std::string& stem = "m") const {
    const Result<Model> model = read_by_opencascade(folder_.file(name(stem), text));
    EXPECT_TRUE(model.ok()) << model.status().message();
    std::vector<Vec3> points;
    if (!model) return points;
    for (const ModelSurface& surface : model->surfaces) {
      const Domain d = domain(surface.surface);
      for (const double s : {0.0, 0.3, 1.0}) points.push_back(evaluate_jet(surface, d.u_at(s), d.v_at(0.7))->position);
    }
    return points;
  }
  void expect_error(const std::string& path, StatusCode code, const std::string& words) const {
    expect_refused(read_by_opencascade(path), code, Status::no_index, path + words);
  }

  ScratchFolder folder_;
  std::string text_;
};
INSTANTIATE_TEST_SUITE_P(Formats, BadCadFile, testing::Values(".step", ".stp", ".iges", ".igs", ".brep", ".brp"),
                         [](const auto& format) { return std::string(format.param + 1); });

TEST_P(BadCadFile, LayoutDoesNotMatter) {
  const std::vector<Vec3> plain = points_of(text_);
  ASSERT_EQ(plain.size(), 3u);
  std::string windows, open = text_;
  for (const char c : text_) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  open.erase(open.find_last_not_of("\n ") + 1);
  EXPECT_EQ(points_of(windows), plain) << "CRLF";
  EXPECT_EQ(points_of(open), plain) << "no end of the last line";
  EXPECT_EQ(points_of("\xEF\xBB\xBF" + text_), plain) << "a byte order mark";
  EXPECT_EQ(points_of("\xEF\xBB\xBF" + windows), plain) << "a byte order mark and CRLF";
  if (std::string_view(GetParam()).starts_with(".s")) {  // IGES has columns
    std::string tabs;
    bool in_string = false;
    for (const char c : text_) {
      if (c == '\'') in_string = !in_string;
      tabs += !in_string && (c == ' ' || c == ',') ? std::string(1, c) + '\t' : std::string(1, c);
    }
    EXPECT_EQ(points_of(tabs), plain) << "tabs";
  }
  // Errors name the file all the same.
  const std::string bad = folder_.file(name("bad"), "\xEF\xBB\xBFnonsense\n");
  expect_refused(read_by_opencascade(bad), StatusCode::parse_error, Status::no_index, bad + ":");
}

TEST_P(BadCadFile, TheLocaleDoesNotMatter) {
  const std::vector<Vec3> plain = points_of(text_);
  const CommaLocale commas;
  if (!commas.done()) GTEST_SKIP() << "no locale with a decimal comma here";
  EXPECT_EQ(points_of(text_), plain);
}

TEST_P(BadCadFile, PathsAreOfAnyCharacters) {
  const std::vector<Vec3> plain = points_of(text_);
  for (const char* const stem :
       {"m\xC3\xB6\x62\x65l \xE5\xA3\xBA", "with blanks", "%s%n%d", "\xff\xfe", "'\"", "a.b.c"})
    EXPECT_EQ(points_of(text_, stem), plain) << stem;
}

TEST_P(BadCadFile, WhatIsNoFileIsNamed) {
  std::filesystem::create_directory(folder_ / name("folder"));
  expect_error(folder_ / name("folder"), StatusCode::io_error, ": is a directory, not a file");
  expect_error(folder_ / name("missing"), StatusCode::io_error, ": cannot be opened: No such file or directory");
  expect_error(folder_.file(name("empty"), ""), StatusCode::parse_error, ": the file is empty");
  // Nobody writes to this pipe: opening it would block.
  ASSERT_EQ(::mkfifo((folder_ / name("pipe")).c_str(), 0600), 0);
  expect_error(folder_ / name("pipe"), StatusCode::unsupported, ": CAD files are read from regular files only");
  std::filesystem::create_symlink("/dev/zero", folder_ / name("zero"));
  expect_error(folder_ / name("zero"), StatusCode::unsupported, ": CAD files are read from regular files only");
}

TEST_P(BadCadFile, NoPermissionIsSaid) {
  const WithoutPrivileges ordinary;
  ASSERT_TRUE(ordinary.done());
  const ScratchFolder folder;
  const std::string path = folder.file(name("m"), text_);
  ::chmod(path.c_str(), 0);
  expect_error(path, StatusCode::io_error, ": cannot be opened: Permission denied");
}

}}  // namespace tessera::test
