// Zip archives of one file: stored, deflated, cut at every byte, damaged, and those that are not for us.

#include "io/file/zip.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "support/allocations.h"

#ifdef TESSERA_HAS_ZLIB
#define ZLIB_CONST  // its pointers point to const
#include <zlib.h>
#endif

namespace tessera::test { namespace {

#ifdef TESSERA_HAS_ZLIB

/// A file of an archive that a test makes.
struct ZipMember {
  std::string name, content;
  bool is_deflated = true;
  unsigned flags = 0;
};

std::string little(std::uint32_t value, int bytes) {
  std::string text;
  for (int k = 0; k < bytes; ++k) text += static_cast<char>(value >> 8 * k & 0xff);
  return text;
}

std::string deflated(std::string_view text) {
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, 9, Z_DEFLATED, -15, 9, Z_DEFAULT_STRATEGY), Z_OK);
  std::string bytes(deflateBound(&stream, text.size()), '\0');
  stream.next_in = reinterpret_cast<const Bytef*>(text.data());
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_out = static_cast<uInt>(bytes.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  bytes.resize(stream.total_out);
  deflateEnd(&stream);
  return bytes;
}

std::string archive(const std::vector<ZipMember>& members, const std::string& comment = "") {
  std::string bytes, directory;
  for (const ZipMember& member : members) {
    const std::string data = member.is_deflated ? deflated(member.content) : member.content;
    const uLong sum = crc32_z(0, reinterpret_cast<const Bytef*>(member.content.data()), member.content.size());
    const std::string facts = little(20, 2) + little(member.flags, 2) + little(member.is_deflated ? 8 : 0, 2) +
                              little(0, 4) + little(static_cast<std::uint32_t>(sum), 4) +
                              little(static_cast<std::uint32_t>(data.size()), 4) +
                              little(static_cast<std::uint32_t>(member.content.size()), 4) +
                              little(static_cast<std::uint32_t>(member.name.size()), 2) + little(2, 2);
    directory += "PK\1\2" + little(20, 2) + facts + little(0, 2) + little(0, 2) + little(0, 2) + little(0, 4) +
                 little(static_cast<std::uint32_t>(bytes.size()), 4) + member.name + "xx";
    bytes += "PK\3\4" + facts + member.name + "xx" + data;
  }
  const auto count = static_cast<std::uint32_t>(members.size());
  return bytes + directory + "PK\5\6" + little(0, 4) + little(count, 2) + little(count, 2) +
         little(static_cast<std::uint32_t>(directory.size()), 4) + little(static_cast<std::uint32_t>(bytes.size()), 4) +
         little(static_cast<std::uint32_t>(comment.size()), 2) + comment;
}

const std::string words = "some words, some words, some words";

std::string message_of(const std::string& bytes, StatusCode code = StatusCode::parse_error) {
  const Status status = unpack_zip(bytes, "m.stpz").status();
  EXPECT_EQ(status.code(), code) << status.message();
  return status.message();
}

TEST(Zip, TheOnlyFileIsUnpacked) {
  for (const bool is_deflated : {false, true}) {
    const ZipMember member{"a.stp", words, is_deflated};
    EXPECT_EQ(*unpack_zip(archive({member}), "m"), words);
    EXPECT_EQ(*unpack_zip(archive({member}, "PK\5\6, a comment"), "m"), words);
    EXPECT_EQ(*unpack_zip(archive({{"folder/", "", false}, member}), "m"), words);
    const std::string large(300000, 'x');
    EXPECT_EQ(*unpack_zip(archive({{"a.stp", large, is_deflated}}), "m"), large);
  }
  EXPECT_TRUE(begins_as_zip(archive({})));
  EXPECT_FALSE(begins_as_zip("PK"));
}

TEST(Zip, CutOrDamagedItIsRefused) {
  for (const bool is_deflated : {false, true}) {
    const std::string whole = archive({{"a.stp", words, is_deflated}});
    for (std::size_t size = 0; size < whole.size(); ++size) {
      const std::vector<char> cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
      EXPECT_FALSE(unpack_zip({cut.data(), cut.size()}, "m").ok()) << size;
    }
    for (std::size_t k = 0; k < whole.size(); ++k)
      for (const int bits : {1, 0x10, 0xff}) {
        std::vector<char> bytes(whole.begin(), whole.end());
        bytes[k] = static_cast<char>(bytes[k] ^ bits);
        const Result<std::string> text = unpack_zip({bytes.data(), bytes.size()}, "m");
        EXPECT_EQ(text.ok() ? *text : words, words) << k;
      }
  }
  EXPECT_EQ(message_of("PK\3\4"), "m.stpz: the zip archive has no end; it may be cut");
  EXPECT_EQ(message_of(archive({})), "m.stpz: the zip archive holds no file");
  EXPECT_EQ(message_of(archive({{"a", ""}})), "m.stpz: the file is empty");
  std::string other = archive({{"a", words, false}});
  other[other.find("words")] = 'W';
  EXPECT_EQ(message_of(other), "m.stpz: the zip archive does not hold what its directory states");
}

TEST(Zip, OtherArchivesAreNamed) {
  EXPECT_EQ(message_of(archive({{"a", words}, {"b", words}}), StatusCode::unsupported),
            "m.stpz: the zip archive holds 2 files, it must hold one; unpack it first (unzip)");
  EXPECT_EQ(message_of(archive({{"a", words, true, 1}}), StatusCode::unsupported),
            "m.stpz: the zip archive is encrypted; unpack it first (unzip)");
  std::string bytes = archive({{"a", words}});
  bytes[bytes.find("PK\1\2") + 10] = 12;
  EXPECT_EQ(message_of(bytes, StatusCode::unsupported),
            "m.stpz: the zip archive uses compression 12; unpack it first (unzip)");
  bytes = archive({{"a", words}});
  for (int k = 16; k < 20; ++k) bytes[bytes.find("PK\5\6") + static_cast<std::size_t>(k)] = '\xff';
  EXPECT_EQ(message_of(bytes, StatusCode::unsupported),
            "m.stpz: the zip archive is of the kind Zip64; unpack it first (unzip)");
}

TEST(Zip, ContentOutOfProportionIsRefusedBeforeItTakesMemory) {
  const std::string bomb = archive({{"a", std::string(std::size_t{64} << 20, '\0')}});
  const std::size_t before = restart_peak();
  const Result<std::string> text = unpack_zip(bomb, "m");
  EXPECT_LE(peak_bytes() - before, std::size_t{1} << 18);
  EXPECT_EQ(text.status().code(), StatusCode::unsupported);
  EXPECT_NE(text.status().message().find("the limit is 200 times the packed file"), std::string::npos);
}

#else

TEST(Zip, WithoutZlibTheMessageSaysWhatToInstall) {
  const Status status = unpack_zip("PK\3\4", "m.stpz").status();
  EXPECT_EQ(status.code(), StatusCode::unsupported);
  EXPECT_NE(status.message().find("zlib1g-dev"), std::string::npos) << status.message();
}

#endif

}}  // namespace tessera::test
