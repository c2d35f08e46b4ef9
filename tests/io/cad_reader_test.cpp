// Programs in the place of tessera-cad-reader that break their word, in every way: a message each, and no harm.

#include "io/cad/cad_reader.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <optional>
#include <thread>

#include "io/cad/kept_model.h"
#include "io/cad/model_bytes.h"
#include "support/errors.h"
#include "support/scratch_folder.h"
#include "tessera/cad.h"
#include "tessera/io.h"
#include "tessera/version.h"

namespace tessera::test { namespace {

namespace fs = std::filesystem;

/// The environment variable, set for a while.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    if (const char* const old = std::getenv(name)) before_ = old;
    ::setenv(name, value.c_str(), 1);
  }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;
  ~Variable() {
    if (before_)
      ::setenv(name_, before_->c_str(), 1);
    else
      ::unsetenv(name_);
  }

 private:
  const char* name_;
  std::optional<std::string> before_;
};

/// Keeps other runs of this program from looking for readers beside it, or putting one there.
class AloneBeside {
 public:
  explicit AloneBeside(const fs::path& folder) : file_(::open((folder / "alone").c_str(), O_CREAT | O_RDWR, 0600)) {
    EXPECT_EQ(::flock(file_, LOCK_EX), 0);
  }
  AloneBeside(const AloneBeside&) = delete;
  AloneBeside& operator=(const AloneBeside&) = delete;
  ~AloneBeside() { ::close(file_); }

 private:
  int file_;
};

std::string as_size(std::uint64_t size) {
  std::string bytes(sizeof size, '\0');
  std::memcpy(bytes.data(), &size, sizeof size);
  return bytes;
}

/// Options of reading by a program.
CadOptions by(const std::string& program, CadFormat format = CadFormat::by_extension) {
  return {.format = format, .reader = program, .step_reader = StepReader::opencascade};
}

class CadReader : public testing::Test {
 protected:
  ~CadReader() override { EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1) << "a child was not collected"; }

  /// The folder of this program.
  static fs::path own_folder() { return fs::canonical("/proc/self/exe").parent_path(); }
  /// A reader that runs this script of the shell.
  std::string reader(const std::string& script, const std::string& name = "reader") const {
    const std::string path = folder_.file(name, "#!/bin/sh\n" + script + "\n");
    fs::permissions(path, fs::perms::owner_all);
    return path;
  }
  /// A reader that prints these bytes.
  std::string printing(const std::string& bytes, const std::string& then = "") const {
    return reader("cat '" + folder_.file("bytes", bytes) + "'\n" + then);
  }
  void expect(const std::string& program, StatusCode code, const std::string& words) const {
    SCOPED_TRACE(words);
    const Result<Model> read = read_cad(part_, by(program));
    expect_refused(read, code, Status::no_index, words);
    EXPECT_EQ(read.status().message().find(part_ + ": "), 0u) << read.status().message();
  }
  static std::string model() {
    Model model{"", {}, {"a warning"}};
    const std::vector<double> knots{0, 0, 1, 1};
    const std::vector<Vec3> points(4);
    model.surfaces.push_back({"face", *BSplineSurface::polynomial(1, knots, 1, knots, points)});
    return to_bytes(model);
  }

  ScratchFolder folder_;
  const std::string part_ = folder_.file("part.step", "ISO-10303-21;");
  const std::string greeting_ = cad_reader_greeting();
};

TEST(IsCadFile, LooksAtTheExtensionAlone) {
  for (const char* path :
       {"a.step", "b.STP", "c.d/e.IgEs", "f.igs", "g.brep", "..brp", "a.p21", "b.stpZ", "c.step.gz", "d.IGS.GZ"})
    EXPECT_TRUE(is_cad_file(path)) << path;
  for (const char* path :
       {"", "step", ".step", "a/.step", "a.step/b", "a.gz", ".step.gz", "a.step.gz.gz", "a.step ", "a.ste", "..", "a."})
    EXPECT_FALSE(is_cad_file(path)) << path;
}

TEST_F(CadReader, AnyProgramThatKeepsItsWordWillDo) {
  const std::string program = printing(greeting_ + as_size(model().size()) + model());
  const Result<Model> read = read_cad(part_, by(program));
  ASSERT_TRUE(read.ok()) << read.status().message();
  EXPECT_EQ(read->name, "part");
  EXPECT_EQ(*read->surfaces.at(0).name, "face");
  EXPECT_EQ(read->warnings, std::vector<std::string>{"a warning"});
  // The greeting says the version, on a line of a fixed length.
  EXPECT_EQ(greeting_.size(), greeting_size);
  EXPECT_EQ(greeting_.find("tessera-cad-reader " TESSERA_VERSION ", models "), 0u) << greeting_;
}

TEST_F(CadReader, ItIsToldTheFormatTheFileAndItsServant) {
  const std::string program = reader("echo \"$@\" > '" + (folder_ / "words") + "'");
  for (const auto& [format, name] : {std::pair{CadFormat::by_extension, "STEP"},
                                     {CadFormat::iges, "IGES"},
                                     {CadFormat::step, "STEP"},
                                     {CadFormat::brep, "BREP"}}) {
    EXPECT_FALSE(read_cad(part_, by(program, format)).ok());
    EXPECT_EQ(content_of(folder_ / "words"), std::string(name) + " " + part_ + " " + std::to_string(::getpid()) + "\n");
  }
}

TEST_F(CadReader, ItsErrorsArePassedOn) {
  const std::string bytes = to_bytes(Status(StatusCode::parse_error, part_ + ": line 3 is wrong", 7));
  expect_refused(read_cad(part_, by(printing(greeting_ + as_size(bytes.size()) + bytes))), StatusCode::parse_error, 7,
                 part_ + ": line 3 is wrong");
}

TEST_F(CadReader, OneThatCannotBeStartedIsNamed) {
  const std::string text = folder_.file("text", "words");
  expect(folder_ / "none", StatusCode::io_error,
         "the CAD reader " + (folder_ / "none") + " cannot be started: No such");
  expect(text, StatusCode::io_error, "the CAD reader " + text + " cannot be started: Permission denied");
  expect(folder_.path().string(), StatusCode::io_error, "the CAD reader " + folder_.path().string() + " cannot be");
}

TEST_F(CadReader, OneOfAnotherVersionIsNamed) {
  std::string other = "tessera-cad-reader 0.0.7, models 1";
  other.resize(greeting_size - 1, ' ');
  const std::string program = printing(other + "\n" + as_size(5) + "12345", "sleep 60");
  expect(program, StatusCode::unsupported,
         "the CAD reader " + program + " is \"tessera-cad-reader 0.0.7, models 1\", it must be \"tessera-cad-reader " +
             TESSERA_VERSION);
}

TEST_F(CadReader, OtherOutputIsQuoted) {
  expect(printing("Hello \x1b[31mworld\nand more"), StatusCode::internal,
         "the CAD reader " + folder_ / "reader" + " printed \"Hello ?[31mworld\", it must begin with \"tessera-cad");
  // The words of the loader for a missing library.
  expect(reader("echo reader: libTKSTEP.so.7: cannot open shared object file: No such file or directory >&2; exit 127"),
         StatusCode::internal,
         "printed \"reader: libTKSTEP.so.7: cannot open shared object file: No such file or directory\"");
  expect(reader("cat /dev/urandom"), StatusCode::internal, "printed \"");
}

TEST_F(CadReader, OneThatSaysNothingIsEnded) {
  for (const std::string& words : {std::string(), std::string("loading ...")})
    expect_refused(run_cad_reader({.reader = printing(words, "sleep 60"),
                                   .format = "STEP",
                                   .file = part_,
                                   .startup = std::chrono::milliseconds(300)}),
                   StatusCode::internal, Status::no_index, "did not say \"" + greeting_.substr(0, 25));
}

TEST_F(CadReader, OneThatEndsTooEarlyIsNamed) {
  const std::string all = greeting_ + as_size(model().size()) + model(), size = std::to_string(model().size());
  const std::string who = "the CAD reader " + folder_ / "reader" + " ended without ";
  expect(reader("exit 3"), StatusCode::internal, who + "a greeting (exit status 3)");
  expect(printing(all.substr(0, greeting_size)), StatusCode::internal, who + "a model (exit status 0)");
  expect(printing(all.substr(0, greeting_size + 5)), StatusCode::internal, who + "a model (exit status 0)");
  expect(printing(all.substr(0, all.size() - 1)), StatusCode::internal,
         who + "1 of " + size + " bytes of the model (exit status 0)");
  // Hangs up, and stays.
  expect(printing(all.substr(0, greeting_size + 20), "exec >/dev/null 2>&1; sleep 60"), StatusCode::internal,
         who + std::to_string(model().size() - 12) + " of " + size + " bytes of the model");
}

TEST_F(CadReader, ItsCrashesAndLimitsAreErrors) {
  for (const auto& [signal, words] : {std::pair{"SEGV", "crashed (Segmentation fault)"},
                                      {"ABRT", "crashed (Aborted)"},
                                      {"KILL", "crashed (Killed)"},
                                      {"XCPU", "did not end within 120 seconds of processor time"}})
    expect(printing(greeting_, std::string("kill -") + signal + " $$"), StatusCode::internal,
           std::string("OpenCASCADE ") + words);
  expect(printing(greeting_, "exit 71"), StatusCode::out_of_memory, "OpenCASCADE exceeded its memory limit");
}

TEST_F(CadReader, DamagedModelsAreErrors) {
  const std::string who = "the CAD reader " + folder_ / "reader" + " ";
  expect(printing(greeting_ + as_size(4) + "abcd"), StatusCode::internal, who + "sent a damaged model");
  expect(printing(greeting_ + as_size(model().size() - 1) + model()), StatusCode::internal,
         who + "sent a damaged model");
  expect(printing(greeting_ + as_size(~std::uint64_t{0}) + model()), StatusCode::internal,
         who + "announced 18446744073709551615 bytes, more than the memory that it may use");
}

TEST_F(CadReader, CancellingEndsIt) {
  const std::string mark = folder_ / "pid";
  const std::string program = printing(greeting_, "echo $$ > '" + mark + "'\nexec sleep 60");
  std::atomic<bool> cancel{false};
  std::thread later([&] {
    for (int k = 0; k < 10'000 && content_of(mark).empty(); ++k)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    cancel = true;
  });
  const Result<Model> read =
      read_cad(part_, {.reader = program, .cancel = &cancel, .step_reader = StepReader::opencascade});
  later.join();
  expect_refused(read, StatusCode::cancelled, Status::no_index, part_ + ": the reading was cancelled");
  EXPECT_EQ(::kill(std::stoi(content_of(mark)), 0), -1) << "it still runs";
}

TEST_F(CadReader, IsLookedForInThisOrder) {
  const AloneBeside alone(own_folder());
  const std::string named = reader("exit 11", "named"), other = reader("exit 12", "other");
  fs::create_directory(folder_ / "bin");
  const std::string third = reader("exit 13", "bin/tessera-cad-reader");
  const Variable path("PATH", "/no/such/folder:" + (folder_ / "bin") + ":/bin:/usr/bin");
  {
    const Variable variable("TESSERA_CAD_READER", other);
    EXPECT_EQ(find_cad_reader({.reader = named})->string(), named);
    EXPECT_EQ(find_cad_reader()->string(), other);
    expect(named, StatusCode::internal, "the CAD reader " + named + " ended without a greeting (exit status 11)");
    expect("", StatusCode::internal, "the CAD reader " + other + " ended without a greeting (exit status 12)");
  }
  const Variable none("TESSERA_CAD_READER", "");
  expect("", StatusCode::internal, "the CAD reader " + third + " ended without a greeting (exit status 13)");
  // Beside this program.
  const fs::path beside = own_folder() / "tessera-cad-reader";
  if (fs::exists(beside)) GTEST_SKIP() << beside << " is in the way";
  fs::copy_file(other, beside);
  expect("", StatusCode::internal, "the CAD reader " + beside.string() + " ended without");
  fs::remove(beside);
  const fs::path libexec = beside.parent_path().parent_path() / "libexec" / "tessera";
  fs::create_directories(libexec);
  fs::copy_file(other, libexec / "tessera-cad-reader");
  expect("", StatusCode::internal, "the CAD reader " + (libexec / "tessera-cad-reader").string() + " ended without");
  fs::remove_all(libexec.parent_path());
}

TEST_F(CadReader, ItsLackIsAnErrorThatSaysWhatToDo) {
  const AloneBeside alone(own_folder());
  const Variable none("TESSERA_CAD_READER", ""), path("PATH", folder_.path().string());
  folder_.file("tessera-cad-reader", "not executable, which PATH passes over");
  const CadOptions options = by("");
  for (const Result<Model>& read : {read_cad(part_, options), read_model(part_, {.cad = options})})
    expect_refused(read, StatusCode::unsupported, Status::no_index,
                   part_ +
                       ": STEP files are read by the program tessera-cad-reader, which is neither beside this "
                       "program, nor in its libexec/tessera, nor on PATH: install the package tessera-cad-reader, run "
                       "tools/cad_reader.sh in Tessera's");
  expect_refused(find_cad_reader(), StatusCode::unsupported, Status::no_index, "CAD files are read by the program");
  // The file comes first.
  expect_refused(read_model(folder_ / "none.igs"), StatusCode::io_error, Status::no_index,
                 "none.igs: cannot be opened");
}

}}  // namespace tessera::test
