// tessera tessellate --in-pieces: the bytes of the whole, for models larger than memory.

#include <sys/resource.h>

#include <filesystem>
#include <fstream>

#include "tools/tool_test.h"

namespace tessera::test { namespace {

class PiecesTest : public ToolTest {
 protected:
  struct Peak {
    double pieces = 0, megabytes = 0;
  };
  /// The most resident memory of a run, which a process of its own asks for: the system keeps the largest of all
  /// children.
  Peak peak_of(const Names& command) const {
    int ends[2];
    EXPECT_EQ(::pipe(ends), 0);
    Peak peak;
    const pid_t child = ::fork();
    if (child == 0) {
      const ToolRun made = run(command);
      rusage usage{};
      ::getrusage(RUSAGE_CHILDREN, &usage);
      if (made.status == 0) peak = {nlohmann::json::parse(made.output)["pieces"], double(usage.ru_maxrss) / 1024};
      std::_Exit(::write(ends[1], &peak, sizeof peak) == sizeof peak ? 0 : 1);
    }
    EXPECT_EQ(::read(ends[0], &peak, sizeof peak), static_cast<ssize_t>(sizeof peak));
    ::waitpid(child, nullptr, 0);
    ::close(ends[0]), ::close(ends[1]);
    return peak;
  }
};

TEST_F(PiecesTest, BytesAreThoseOfTheWhole) {
  const std::string g2 = TESSERA_SOURCE_DIR "/tests/corpus/g2/elementary.g2";
  for (const std::string& model : {teapot, g2})
    for (const Names& options :
         {Names{}, Names{"--tolerance", "0.001"}, Names{"--grid", "5x3"}, Names{"--relative", "1e-3", "--quads"},
          Names{"--tolerance", "0.01", "--angle", "10", "--precision", "double"}, Names{"--weld", "0"}}) {
      Names whole{"tessellate", model, "-o", "whole.ply"}, pieces{"tessellate", model, "-o", "pieces.ply", "--json"};
      whole.insert(whole.end(), options.begin(), options.end());
      pieces.insert(pieces.end(), options.begin(), options.end());
      run(whole);
      for (const char* size : {"1K", "40K", "1G"}) {
        Names command = pieces;
        command.insert(command.end(), {"--in-pieces", size});
        const ToolRun made = run(command);
        ASSERT_EQ(made.status, 0) << made.errors;
        const auto report = nlohmann::json::parse(made.output);
        if (std::string(size) == "1K") {
          EXPECT_EQ(report["pieces"], report["surfaces"]);
        }
        if (std::string(size) == "1G") {
          EXPECT_EQ(report["pieces"], 1);
        }
        EXPECT_TRUE(content_of(folder_ / "whole.ply") == content_of(folder_ / "pieces.ply")) << size << made.output;
      }
    }
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST_F(PiecesTest, MemoryIsThatOfAPieceAndOfTheProgram) {
  constexpr int count = 150;
  std::ofstream file(folder_ / "field.bpt");
  file << count * count << '\n';
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j) {
      file << "3 3\n";
      for (int a = 0; a < 4; ++a)
        for (int b = 0; b < 4; ++b)
          file << 3 * i + a << ' ' << 3 * j + b << ' ' << ((3 * i + a) * 7 + (3 * j + b) * 5) % 11 * 0.25 << '\n';
    }
  file.close();
  for (const int megabytes : {4, 8, 32}) {
    const Peak peak = peak_of({"tessellate", "field.bpt", "-o", "a.ply", "--json", "--relative", "1e-3", "--threads",
                               "2", "--in-pieces", std::to_string(megabytes) + "M"});
    EXPECT_GT(peak.pieces, 1) << megabytes;
    // The program, a piece that is "about" so large, and the search for neighbours, as the guide states them.
    EXPECT_LE(peak.megabytes, 20 + 1.25 * megabytes + 0.2 * peak.pieces) << peak.pieces;
  }
}
#endif

TEST_F(PiecesTest, AnIndexNamesFilesOfPieces) {
  const std::string output = output_of({"tessellate", teapot, "-o", "new/a.pvtp", "--in-pieces", "100K"});
  EXPECT_NE(output.find(" pieces, "), std::string::npos) << output;
  const std::string index = content_of(folder_ / "new/a.pvtp");
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "new")) {
    if (entry.path().extension() == ".pvtp") continue;
    ++files;
    EXPECT_NE(index.find("\"" + entry.path().filename().string() + "\""), std::string::npos) << entry.path();
  }
  EXPECT_GE(files, 2u);
  EXPECT_EQ(output.rfind("new/a.pvtp: " + std::to_string(files) + " pieces", 0), 0u) << output;
}

TEST_F(PiecesTest, OtherFilesAndOptionsAreErrors) {
  const std::string goblet = TESSERA_SOURCE_DIR "/tools/models/goblet.json";
  expect_failure({"tessellate", goblet, "-o", "a.ply", "--in-pieces", "1G"}, 2, "goblet.json: expected .bpt or .g2");
  expect_failure({"tessellate", teapot, "-o", "a.stl", "--in-pieces", "1G"}, 2, "a.stl: expected .ply or .pvtp");
  expect_failure({"tessellate", teapot, "-o", "a.pvtp"}, 2, ".pvtp is written with --in-pieces SIZE only");
  expect_failure({"tessellate", teapot, teapot, "-o", "a.ply", "--in-pieces", "1G"}, 2,
                 "each output is made of one file");
  for (const char* option : {"--share-vertices", "--fewest"})
    expect_failure({"tessellate", teapot, "-o", "a.ply", "--in-pieces", "1G", option}, 2, option);
  expect_failure({"tessellate", teapot, "-o", "a.ply", "--in-pieces", "0"}, 2,
                 "--in-pieces: expected a size like 800M or 12G, found ");
}

TEST_F(PiecesTest, FaultsLeaveNothing) {
  std::string text = content_of(teapot);
  text.replace(text.rfind("0."), 2, "nan ");
  folder_.file("bad.bpt", text);
  for (const char* output : {"a.ply", "new/a.pvtp"})
    expect_failure({"tessellate", "bad.bpt", "-o", output, "--in-pieces", "100K"}, 1, "bad.bpt:");
  expect_failure({"tessellate", teapot, "-o", "a.pvtp", "--in-pieces", "100K", "--max-triangles", "10"}, 1, "limit");
  expect_failure({"tessellate", teapot, "-o", "a.ply", "--in-pieces", "100K", "--max-triangles", "1000"}, 1, "limit");
}

}}  // namespace tessera::test
