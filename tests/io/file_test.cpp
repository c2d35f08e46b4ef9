// Reads whole files; writes files that appear whole or not at all.

#include "io/file/file.h"
#include "io/file/output_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>

#include "support/privileges.h"
#include "support/scratch_folder.h"
#include "tessera/io.h"

namespace tessera { namespace {

using test::content_of;
using test::ScratchFolder;
using test::WithoutPrivileges;
using Names = std::vector<std::string>;

Status write_text(const std::string& path, std::string_view text) {
  Result<OutputFile> out = OutputFile::make(path);
  if (!out) return out.status();
  out->write(text);
  return out->commit();
}

TEST(MicrometresIn, QuotientsOfUnitsAreRoundedOnce) {
  for (const auto& [unit, metres] : {std::pair{"um", 1e-6},
                                     {"mm", 1e-3},
                                     {"cm", 1e-2},
                                     {"m", 1.},
                                     {"km", 1e3},
                                     {"in", 0.0254},
                                     {"inch", 0.0254},
                                     {"ft", 0.3048}})
    EXPECT_EQ(micrometres_in(unit) / micrometres_in("m"), metres) << unit;
  EXPECT_EQ(micrometres_in("in") / micrometres_in("mm"), 25.4);
  for (const char* const other : {"", "MM", "mm ", "yard"}) EXPECT_EQ(micrometres_in(other), 0) << other;
}

TEST(ReadFile, BytesComeAsTheyAre) {
  const ScratchFolder folder;
  std::string bytes(100000, '\0');
  for (std::size_t k = 0; k < bytes.size(); ++k) bytes[k] = static_cast<char>(k * 7);
  const Result<std::string> read = read_file(folder.file("a", bytes));
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(*read, bytes);
}

TEST(ReadFile, LongFilesComeAsTheyAre) {
  const ScratchFolder folder;
  std::string bytes((std::size_t{9} << 20) + 77, '\0');
  for (std::size_t k = 0; k < bytes.size(); ++k) bytes[k] = static_cast<char>(k % 251);
  const Result<std::string> read = read_file(folder.file("a", bytes));
  ASSERT_TRUE(read.ok());
  EXPECT_TRUE(*read == bytes);
}

TEST(ReadFile, WhatCannotBeReadIsNamed) {
  const ScratchFolder folder;
  const std::string missing = folder / "missing", empty = folder.file("empty", "");
  const Result<std::string> no_file = read_file(missing), no_bytes = read_file(empty),
                            no_text = read_file(folder.path());
  EXPECT_EQ(no_file.status().message(), missing + ": cannot be opened: No such file or directory");
  EXPECT_EQ(no_file.status().code(), StatusCode::io_error);
  EXPECT_EQ(no_bytes.status().message(), empty + ": the file is empty");
  EXPECT_EQ(no_bytes.status().code(), StatusCode::parse_error);
  EXPECT_EQ(no_text.status().message(), folder.path().string() + ": is a directory, not a file");
  EXPECT_EQ(no_text.status().code(), StatusCode::io_error);
  const std::string sparse = folder.file("sparse", "");
  std::filesystem::resize_file(sparse, std::uintmax_t{1} << 42);
  const Result<std::string> too_large = read_file(sparse);
  EXPECT_EQ(too_large.status().code(), StatusCode::out_of_memory);
  EXPECT_NE(too_large.status().message().find(": has 4398046511104 bytes, the memory of this machine "),
            std::string::npos);
}

TEST(ReadFile, NoPermissionIsSaid) {
  const WithoutPrivileges ordinary;
  ASSERT_TRUE(ordinary.done());
  const ScratchFolder folder;
  const std::string path = folder.file("a", "text");
  ::chmod(path.c_str(), 0);
  EXPECT_EQ(read_file(path).status().message(), path + ": cannot be opened: Permission denied");
}

TEST(ReadFile, FilesThatStateNoSizeAreRead) {
  const Result<std::string> read = read_file("/proc/self/status");
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(read->rfind("Name:", 0), 0u);
}

TEST(OutputFile, AppearsAtCommitAndNotBefore) {
  const ScratchFolder folder;
  {
    Result<OutputFile> out = OutputFile::make(folder / "a.txt");
    ASSERT_TRUE(out.ok());
    out->write("text");
    EXPECT_FALSE(std::filesystem::exists(folder / "a.txt"));
    EXPECT_TRUE(out->commit().ok());
    EXPECT_EQ(content_of(folder / "a.txt"), "text");
  }
  EXPECT_EQ(folder.names(), Names{"a.txt"});
}

TEST(OutputFile, WithoutCommitNothingStaysBehind) {
  const ScratchFolder folder;
  folder.file("a.txt", "before");
  {
    Result<OutputFile> out = OutputFile::make(folder / "a.txt");
    ASSERT_TRUE(out.ok());
    out->write(std::string(3 << 20, 'x'));
    EXPECT_EQ(folder.names().size(), 2u);
  }
  EXPECT_EQ(folder.names(), Names{"a.txt"});
  EXPECT_EQ(content_of(folder / "a.txt"), "before");
}

TEST(OutputFile, NamesAreAsLongAsTheFolderTakes) {
  const ScratchFolder folder;
  for (const std::size_t length : {236u, 237u, 243u, 244u, 254u, 255u}) {
    // Two names that differ at their ends alone are written at once.
    const std::string start(length - 1, 'n'), first = folder / (start + 'a'), second = folder / (start + 'b');
    Result<OutputFile> one = OutputFile::make(first), other = OutputFile::make(second);
    ASSERT_TRUE(one.ok() && other.ok()) << length << " " << one.status().message();
    EXPECT_NE(one->temporary(), other->temporary());
    one->write("one"), other->write("other");
    EXPECT_TRUE(one->commit().ok() && other->commit().ok());
    EXPECT_EQ(content_of(first), "one");
    EXPECT_EQ(content_of(second), "other");
    EXPECT_EQ(folder.names().size(), 2u) << length;
    std::filesystem::remove(first), std::filesystem::remove(second);
  }
  EXPECT_EQ(write_text(folder / std::string(256, 'n'), "x").code(), StatusCode::io_error);
}

TEST(OutputFile, PiecesOfEverySizeArriveInOrder) {
  const ScratchFolder folder;
  std::string expected;
  Result<OutputFile> out = OutputFile::make(folder / "a");
  ASSERT_TRUE(out.ok());
  for (const std::size_t size : {1u, 1000u, 32767u, 32768u, 65535u, 1u, 65536u, 0u, 65537u, 3000000u, 17u}) {
    const std::string piece(size, static_cast<char>('a' + size % 26));
    out->write(piece);
    out->write('|');
    out->write_number(size);
    expected += piece + "|" + std::to_string(size);
  }
  ASSERT_TRUE(out->commit().ok());
  EXPECT_EQ(content_of(folder / "a"), expected);
}

TEST(OutputFile, WhatCannotBeWrittenIsNamed) {
  const ScratchFolder folder;
  const std::string in_no_folder = folder / "none/a.txt";
  EXPECT_EQ(write_text(in_no_folder, "x").message(),
            in_no_folder + ": cannot be written: there is no folder " + (folder / "none"));
  EXPECT_EQ(write_text(folder.path().string(), "x").message(),
            folder.path().string() + ": cannot be written: it is a directory");
  const std::string below_a_file = folder.file("f", "x") + "/a.txt";
  EXPECT_EQ(write_text(below_a_file, "x").code(), StatusCode::io_error);
  EXPECT_EQ(folder.names(), Names{"f"});
}

TEST(OutputFile, ProtectedFilesStay) {
  const WithoutPrivileges ordinary;
  ASSERT_TRUE(ordinary.done());
  const ScratchFolder folder;
  const std::string path = folder.file("a", "before");
  ::chmod(path.c_str(), 0444);
  EXPECT_EQ(write_text(path, "after").message(), path + ": cannot be written: Permission denied");
  EXPECT_EQ(content_of(path), "before");
}

TEST(OutputFile, LinksStayLinks) {
  const ScratchFolder folder;
  folder.file("target", "before");
  ::chmod((folder / "target").c_str(), 0640);
  std::filesystem::create_symlink("target", folder / "link");
  ASSERT_TRUE(write_text(folder / "link", "after").ok());
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(content_of(folder / "target"), "after");
  EXPECT_EQ(static_cast<unsigned>(std::filesystem::status(folder / "target").permissions()), 0640u);
}

TEST(OutputFile, LinksToNothingGetTheirTarget) {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder / "below");
  std::filesystem::create_symlink("below/second", folder / "first");
  std::filesystem::create_symlink("../target", folder / "below/second");
  ASSERT_TRUE(write_text(folder / "first", "text").ok());
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "first"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "below/second"));
  EXPECT_EQ(content_of(folder / "target"), "text");
  EXPECT_EQ(folder.names(), (Names{"below", "first", "target"}));
}

TEST(OutputFile, LinksInACircleAreRefused) {
  const ScratchFolder folder;
  std::filesystem::create_symlink("b", folder / "a");
  std::filesystem::create_symlink("a", folder / "b");
  EXPECT_EQ(write_text(folder / "a", "text").message(),
            (folder / "a") + ": cannot be written: Too many levels of symbolic links");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "a"));
}

TEST(OutputFile, AFullDeviceIsAnError) {
  const Status status = write_text("/dev/full", "text");
  EXPECT_EQ(status.code(), StatusCode::io_error);
  EXPECT_EQ(status.message(), "/dev/full: cannot be written: No space left on device");
}

TEST(OutputFile, StandardOutputThatIsClosedIsAnError) {
  std::fflush(stdout);
  const int kept = ::dup(STDOUT_FILENO);
  ::close(STDOUT_FILENO);
  const Result<OutputFile> out = OutputFile::standard_output();
  ::dup2(kept, STDOUT_FILENO);
  ::close(kept);
  ASSERT_FALSE(out.ok());
  EXPECT_EQ(out.status().code(), StatusCode::io_error);
  EXPECT_EQ(out.status().message(), "standard output: cannot be written: Bad file descriptor");
}

TEST(OutputFile, AFailureInTheMiddleLeavesNothing) {
  const ScratchFolder folder;
  folder.file("a", "before");
  struct rlimit limit {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &limit), 0);
  const struct rlimit small { .rlim_cur = 2 << 20, .rlim_max = limit.rlim_max };
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  Status status;
  {
    Result<OutputFile> out = OutputFile::make(folder / "a");
    ASSERT_TRUE(out.ok());
    for (int k = 0; k < 100 && !out->failed(); ++k) out->write(std::string(100000, 'x'));
    EXPECT_TRUE(out->failed());
    status = out->commit();
  }
  ::setrlimit(RLIMIT_FSIZE, &limit);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(status.code(), StatusCode::io_error);
  EXPECT_EQ(status.message(), (folder / "a") + ": cannot be written: File too large");
  EXPECT_EQ(folder.names(), Names{"a"});
  EXPECT_EQ(content_of(folder / "a"), "before");
}

}}  // namespace tessera
