// CAD files from memory and packed ones, and who reads STEP. The program that reads is a script here.

#include "io/cad/cad_input.h"

#include <gtest/gtest.h>

#include "io/cad/cad_reader.h"
#include "io/cad/kept_model.h"
#include "io/cad/model_bytes.h"
#include "support/errors.h"
#include "support/scratch_folder.h"
#include "tessera/cad.h"
#include "tessera/io.h"

namespace tessera::test { namespace {

namespace fs = std::filesystem;

[[maybe_unused]] const std::string packed_words(
    "\x1f\x8b\x08\x00\x00\x00\x00\x00\x02\x03\x2b\xcf\x2f\x4a\x29\xe6\x02\x00\x86\xb4\xa8\xd6\x06\x00\x00\x00",
    26);  // "words\n" by gzip

class CadInputTest : public testing::Test {
 protected:
  std::string program(const std::string& script) const {
    const std::string path = folder_.file("reader", "#!/bin/sh\n" + script + "\n");
    fs::permissions(path, fs::perms::owner_all);
    return path;
  }
  /// A program that answers with these bytes and keeps a copy of the file that it was to read.
  std::string answering(const std::string& bytes) const {
    const std::uint64_t size = bytes.size();
    const std::string head(reinterpret_cast<const char*>(&size), sizeof size);
    return program("cat \"$2\" > '" + (folder_ / "seen") + "'; echo \"$1 $2\" > '" + (folder_ / "words") + "'; cat '" +
                   folder_.file("answer", cad_reader_greeting() + head + bytes) + "'");
  }
  /// A model with warnings that begin with `path`, where the program is asked for that file.
  static std::string model(std::size_t surfaces, const std::vector<std::string>& warnings) {
    Model model{"", {}, warnings};
    const std::vector<double> knots{0, 0, 1, 1};
    const std::vector<Vec3> points(4);
    for (std::size_t k = 0; k < surfaces; ++k)
      model.surfaces.push_back({"face", *BSplineSurface::polynomial(1, knots, 1, knots, points)});
    return to_bytes(model);
  }
  static CadOptions by(const std::string& program) {
    return {.reader = program, .step_reader = StepReader::opencascade};
  }
  std::string seen() const { return content_of(folder_ / "seen"); }

  const ScratchFolder folder_;
};

TEST_F(CadInputTest, TheProgramReadsAFileItself) {
  const std::string path = folder_.file("part.step", "words\n");
  const Result<Model> read = read_cad(path, by(answering(model(1, {}))));
  ASSERT_TRUE(read.ok()) << read.status().message();
  EXPECT_EQ(content_of(folder_ / "words"), "STEP " + path + "\n");
}

TEST_F(CadInputTest, BytesAreAFileToTheProgram) {
  const std::string program = answering(model(1, {}));
  for (const auto& [name, format] : {std::pair{"a.step", "STEP"}, {"b.IGS", "IGES"}, {"c.brep", "BREP"}}) {
    const Result<Model> read = parse_cad("words\n", name, by(program));
    ASSERT_TRUE(read.ok()) << read.status().message();
    EXPECT_EQ(read->name, fs::path(name).stem());
    EXPECT_EQ(seen(), "words\n");
    EXPECT_TRUE(content_of(folder_ / "words").starts_with(format));
  }
  CadOptions options = by(program);
  options.format = CadFormat::iges;
  EXPECT_TRUE(parse_cad("words\n", "upload", options).ok());
  EXPECT_EQ(parse_model("words\n", "upload", {.format = "iges", .cad = options})->name, "upload");
  expect_refused(parse_cad("words\n", "upload", by(program)), StatusCode::unsupported, Status::no_index,
                 "upload: unsupported format \"\": CAD files are read as .brep, .brp, .iges, .igs, .p21, .step, .stp, "
                 ".stpz");
  expect_refused(parse_cad("", "a.step", by(program)), StatusCode::parse_error, Status::no_index,
                 "a.step: the file is empty");
}

TEST_F(CadInputTest, MessagesNameTheSourceNotTheCopy) {
  Result<CadInput> input = CadInput::memory("words\n", "a.step");
  const Result<std::string> copy = input->file();
  ASSERT_TRUE(copy.ok());
  const auto run_of = [&](const std::string& bytes) {
    return run_cad_reader({answering(bytes), "STEP", *copy, "a.step", 6, nullptr});
  };
  const Result<Model> read = run_of(model(1, {*copy + ": one", "two"}));
  ASSERT_TRUE(read.ok()) << read.status().message();
  EXPECT_EQ(read->warnings, (std::vector<std::string>{"a.step: one", "two"}));
  expect_refused(run_of(to_bytes(Status(StatusCode::parse_error, *copy + ": line 3 is wrong", 7))),
                 StatusCode::parse_error, 7, "a.step: line 3 is wrong");
}

#ifdef TESSERA_HAS_ZLIB
TEST_F(CadInputTest, PackedFilesAreUnpackedWhateverTheirName) {
  const std::string program = answering(model(1, {}));
  for (const char* const name : {"a.step.gz", "a.stpz", "a.STPZ", "a.stp", "a.p21", "a.igs.gz", "a.brep"}) {
    const std::string path = folder_.file(name, packed_words);
    for (const Result<Model>& read : {read_cad(path, by(program)), parse_cad(packed_words, name, by(program)),
                                      read_model(path, {.cad = by(program)})}) {
      ASSERT_TRUE(read.ok()) << read.status().message();
      EXPECT_EQ(read->name, "a");
      EXPECT_EQ(seen(), "words\n");
    }
    fs::remove(folder_ / "seen");
  }
  for (std::size_t size = 2; size < packed_words.size(); ++size)
    expect_refused(parse_cad(packed_words.substr(0, size), "a.stpz", by(program)), StatusCode::parse_error,
                   Status::no_index, "a.stpz: the file ends within the gzip data, after ");
  expect_refused(parse_cad("words\n", "a.step.gz", by(program)), StatusCode::parse_error, Status::no_index,
                 "a.step.gz: expected gzip data, found \"words");
  expect_refused(read_cad(folder_.file("b.stpz", "PK\3\4"), by(program)), StatusCode::parse_error, Status::no_index,
                 "b.stpz: the zip archive has no end");
  EXPECT_FALSE(fs::exists(folder_ / "seen"));
}
#endif

TEST_F(CadInputTest, TesserasReaderStartsNoProgram) {
  const std::string program = answering(model(1, {}));
  for (const char* const format : {"step", "stp.gz", "p21"})
    EXPECT_FALSE(parse_model("nonsense", "part",
                             {.format = format, .cad = {.reader = program, .step_reader = StepReader::tessera}})
                     .ok());
  EXPECT_FALSE(fs::exists(folder_ / "seen"));
  // Other formats need it.
  EXPECT_TRUE(parse_cad("words\n", "a.igs", {.reader = program, .step_reader = StepReader::tessera}).ok());
}

TEST_F(CadInputTest, EitherReaderTakesTheProgramWhereTheLibraryFails) {
  const CadOptions options{.reader = answering(model(2, {"a warning"})), .step_reader = StepReader::either};
  const Result<Model> read = parse_cad("nonsense", "a.step", options);
  ASSERT_TRUE(read.ok()) << read.status().message();
  EXPECT_EQ(read->surfaces.size(), 2u);
  // If both fail, the library's reason is told.
  const Status own = parse_cad("nonsense", "a.step", {.step_reader = StepReader::tessera}).status();
  const CadOptions failing{.reader = program("exit 3"), .step_reader = StepReader::either};
  EXPECT_EQ(parse_cad("nonsense", "a.step", failing).status().message(), own.message());
  // A cancelled call is cancelled, whoever reads.
  const std::atomic<bool> cancel{true};
  const CadOptions slow{.reader = program("exec sleep 60"), .cancel = &cancel, .step_reader = StepReader::either};
  EXPECT_EQ(parse_cad("nonsense", "a.step", slow).status().code(), StatusCode::cancelled);
}

}}  // namespace tessera::test
