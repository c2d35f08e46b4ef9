// Faults of the file system that every reader must report, in each format.

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <thread>

#include "io/text_formats.h"
#include "support/privileges.h"
#include "support/scratch_folder.h"

namespace tessera::test { namespace {

class BadFile : public testing::TestWithParam<TextFormat> {
 protected:
  std::string sample() const { return GetParam().samples().at(0); }
  std::string name(std::string_view stem) const { return std::string(stem) + GetParam().extension; }
  Reading open(const std::filesystem::path& path) const { return GetParam().open(path); }
  void expect_refused(const std::string& path, StatusCode code, const std::string& words) const {
    const Reading reading = open(path);
    EXPECT_EQ(reading.status.code(), code) << reading.status.message();
    EXPECT_EQ(reading.status.message(), path + words);
  }
  ScratchFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(Formats, BadFile, testing::ValuesIn(text_formats()),
                         [](const auto& format) { return format.param.name; });

TEST_P(BadFile, PathsAreOfAnyCharacters) {
  const std::string plain = open(folder_.file(name("plain"), sample())).content;
  EXPECT_NE(plain, "");
  std::filesystem::create_directory(folder_ /
                                    "m\xC3\xB6"
                                    "bel \xE5\xA3\xBA %n");
  for (const char* const stem :
       {"m\xC3\xB6"
        "bel \xE5\xA3\xBA %n/t\xC3\xA9i\xC3\xA8re",
        "with blanks", "%s%n%d", "a\nb", "\xff\xfe no UTF-8", "'\"\\", "-rf", ".hidden", "a.b.c"}) {
    EXPECT_TRUE(open(folder_.file(name(stem), sample())).content == plain) << stem;
    const std::string bad = folder_.file(name(stem), "\n\nnonsense");
    EXPECT_TRUE(open(bad).status.message().starts_with(bad + ":")) << open(bad).status.message();
  }
}

TEST_P(BadFile, WhatIsNoFileIsNamed) {
  std::filesystem::create_directory(folder_ / name("folder"));
  expect_refused(folder_ / name("folder"), StatusCode::io_error, ": is a directory, not a file");
  expect_refused(folder_ / name("missing"), StatusCode::io_error, ": cannot be opened: No such file or directory");
  expect_refused(folder_.file(name("empty"), ""), StatusCode::parse_error, ": the file is empty");
  std::filesystem::create_symlink(name("loop"), folder_ / name("loop"));
  expect_refused(folder_ / name("loop"), StatusCode::io_error, ": cannot be opened: Too many levels of symbolic links");
  std::filesystem::create_symlink("/dev/null", folder_ / name("null"));
  expect_refused(folder_ / name("null"), StatusCode::parse_error, ": the file is empty");
  const std::string below = folder_.file("file", "x") + "/" + name("m");
  expect_refused(below, StatusCode::io_error, ": cannot be opened: Not a directory");
}

TEST_P(BadFile, NoPermissionIsSaid) {
  const std::string text = sample();  // the tests may lie in a folder of root's
  const WithoutPrivileges ordinary;
  ASSERT_TRUE(ordinary.done());
  const ScratchFolder folder;
  const std::string path = folder.file(name("m"), text);
  ::chmod(path.c_str(), 0);
  expect_refused(path, StatusCode::io_error, ": cannot be opened: Permission denied");
}

TEST_P(BadFile, PipesAreReadToTheirEnd) {
  const std::string path = folder_ / name("pipe");
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  const std::string text = sample(), plain = open(folder_.file(name("plain"), text)).content;
  std::thread writer([&] {
    std::ofstream pipe(path, std::ios::binary);
    for (const char c : text) pipe.put(c).flush();
  });
  const Reading reading = open(path);
  writer.join();
  EXPECT_TRUE(reading.ok()) << reading.status.message();
  EXPECT_TRUE(reading.content == plain);
  std::thread closer([&] { std::ofstream pipe(path); });
  expect_refused(path, StatusCode::parse_error, ": the file is empty");
  closer.join();
}

TEST_P(BadFile, LinksAreFollowed) {
  const std::string path = folder_.file(name("m"), sample());
  std::filesystem::create_symlink(name("m"), folder_ / name("link"));
  EXPECT_TRUE(open(folder_ / name("link")).content == open(path).content);
}

}}  // namespace tessera::test
