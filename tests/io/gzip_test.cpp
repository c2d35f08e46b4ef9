// Files packed by gzip: every text format, and files that are cut, damaged, or larger than they should be.

#include "io/file/gzip.h"

#include <gtest/gtest.h>

#include "io/text_formats.h"
#include "support/allocations.h"
#include "support/scratch_folder.h"
#include "tessera/io.h"

#ifdef TESSERA_HAS_ZLIB
#define ZLIB_CONST  // next_in points to const
#include <zlib.h>
#endif

namespace tessera::test { namespace {

#ifdef TESSERA_HAS_ZLIB

/// One member of gzip.
std::string packed(std::string_view text) {
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, 9, Z_DEFLATED, 15 + 16, 9, Z_DEFAULT_STRATEGY), Z_OK);
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

std::string message_of(const std::string& bytes) { return unpack_gzip(bytes, "m.gz").status().message(); }

TEST(Gzip, EveryFormatIsReadPacked) {
  const ScratchFolder folder;
  for (const TextFormat& format : text_formats()) {
    const std::string sample = format.samples().at(0);
    const Reading plain = format.open(folder.file("m" + format.extension, sample));
    ASSERT_TRUE(plain.ok()) << format.name << plain.status.message();
    for (const char* const extension : {".gz", ".GZ"}) {
      const Reading reading = format.open(folder.file("m" + format.extension + extension, packed(sample)));
      EXPECT_TRUE(reading.ok()) << format.name << reading.status.message();
      EXPECT_TRUE(reading.content == plain.content) << format.name;
    }
    // Messages name the packed file, and the line of its content.
    const std::string bad = folder.file("bad" + format.extension + ".gz", packed("\n\nnonsense"));
    EXPECT_TRUE(format.open(bad).status.message().starts_with(bad + ":")) << format.open(bad).status.message();
  }
  const std::string corpus = TESSERA_SOURCE_DIR "/tests/corpus/";
  EXPECT_TRUE(read_mesh(folder.file("m.stl.gz", packed(content_of(corpus + "stl/ascii.stl")))).ok());
  EXPECT_TRUE(read_mesh(folder.file("m.glb.gz", packed(content_of(corpus + "gltf/strip.glb")))).ok());
  EXPECT_EQ(read_model(folder.file("teapot.a.bpt.gz", packed(content_of(corpus + "bpt/bilinear.bpt"))))->name,
            "teapot.a");
}

TEST(Gzip, RibIsAlsoReadPackedUnderItsOwnName) {
  const ScratchFolder folder;
  const std::string scene = content_of(TESSERA_SOURCE_DIR "/tests/corpus/rib/scene.rib");
  EXPECT_TRUE(read_model(folder.file("m.rib", packed(scene))).ok());
  EXPECT_FALSE(read_model(folder.file("m.json", packed("{}"))).ok());
}

TEST(Gzip, MembersAreConcatenated) {
  EXPECT_EQ(*unpack_gzip(packed("ab") + packed("") + packed("cd"), "m"), "abcd");
  const std::string long_text(300000, 'x');  // more than the window in which bytes are counted
  EXPECT_EQ(*unpack_gzip(packed(long_text) + packed("y"), "m"), long_text + "y");
}

TEST(Gzip, CutAtEveryByteItIsRefused) {
  const std::string whole = packed("one") + packed("two and more, and more, and more");
  const std::size_t first = packed("one").size();
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const std::vector<char> cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    const Result<std::string> text = unpack_gzip({cut.data(), cut.size()}, "m.gz");
    EXPECT_EQ(text.ok(), size == first) << size;
    if (!text.ok()) {
      EXPECT_EQ(text.status().code(), StatusCode::parse_error);
      EXPECT_TRUE(text.status().message().starts_with("m.gz: ")) << text.status().message();
    }
  }
  EXPECT_EQ(message_of(whole.substr(0, 12)), "m.gz: the file ends within the gzip data, after 12 bytes");
}

TEST(Gzip, DamageIsFound) {
  const std::string words = "some words that are packed", whole = packed(words);
  std::size_t refused = 0;
  for (std::size_t k = 10; k < whole.size(); ++k) {  // behind the header, whose time and system mean nothing
    std::string bytes = whole;
    bytes[k] = static_cast<char>(bytes[k] ^ 0x10);
    const Result<std::string> text = unpack_gzip(bytes, "m");
    refused += !text.ok();
    EXPECT_EQ(text.ok() ? *text : words, words);  // a bit of padding does not count
  }
  EXPECT_GE(refused, whole.size() - 11);
  EXPECT_EQ(message_of(whole + "abc"), "m.gz: 3 bytes follow the end of the gzip data");
  EXPECT_EQ(message_of("v 0 0 0\n"),
            "m.gz: expected gzip data, found \"v 0 0 0\\x0a\"; remove .gz from the name if the file is not packed");
  EXPECT_EQ(message_of(packed("")), "m.gz: the file is empty");
}

TEST(Gzip, ContentOutOfProportionIsRefusedBeforeItTakesMemory) {
  const std::string bomb = packed(std::string(std::size_t{64} << 20, '\0'));  // 65 kB
  const std::size_t before = restart_peak();
  const Result<std::string> text = unpack_gzip(bomb, "m.gz");
  EXPECT_LE(peak_bytes() - before, std::size_t{1} << 18);
  EXPECT_EQ(text.status().code(), StatusCode::unsupported);
  EXPECT_EQ(text.status().message(), "m.gz: unpacks to more than " + std::to_string(200 * bomb.size() + (1 << 20)) +
                                         " bytes; the limit is 200 times the packed file and 1 MiB, and 1 GiB at the "
                                         "most; unpack it first (gunzip) if you trust it");
  std::string many;  // members do not hide it
  for (int k = 0; k < 3; ++k) many += bomb;
  EXPECT_EQ(unpack_gzip(many, "m.gz").status().code(), StatusCode::unsupported);
  EXPECT_EQ(unpack_gzip(packed(std::string(1000000, ' ')), "m.gz")->size(), 1000000u);
}

TEST(Gzip, NamesInsideMustBeOfAFormat) {
  const ScratchFolder folder;
  for (const char* const name : {"m.gz", "m.txt.gz", "m.gz.gz"}) {
    const Status status = read_model(folder.file(name, packed("x"))).status();
    EXPECT_EQ(status.code(), StatusCode::unsupported) << name;
    EXPECT_NE(status.message().find("surfaces are read as .bpt"), std::string::npos) << status.message();
  }
  // Nothing is written packed, and not under a name that says so.
  Mesh mesh;
  mesh.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  mesh.indices = {0, 1, 2};
  EXPECT_EQ(write_mesh(mesh, folder / "m.obj.gz").code(), StatusCode::unsupported);
}

#else

TEST(Gzip, WithoutZlibTheMessageSaysWhatToInstall) {
  const Status status = unpack_gzip("\x1f\x8b", "m.gz").status();
  EXPECT_EQ(status.code(), StatusCode::unsupported);
  EXPECT_NE(status.message().find("zlib1g-dev"), std::string::npos) << status.message();
}

#endif

}}  // namespace tessera::test
