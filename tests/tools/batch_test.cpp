// Many files from a list: worker processes, shards, what is done before, and files that fail, hang or take much memory.

#include <sys/stat.h>

#include <chrono>
#include <fstream>
#include <set>
#include <thread>

#include "tools/tool_test.h"

namespace tessera::test {
namespace {

class Batch : public ToolTest {
 protected:
  /// A list of so many copies of a small model, and its path.
  std::string list_of(int count) {
    std::string text = "# copies\n\n";
    for (int k = 0; k < count; ++k) {
      const std::string name = "m" + std::to_string(k) + ".json";
      std::filesystem::copy_file(TESSERA_SOURCE_DIR "/tools/models/bezier_bicubic.json", folder_ / name);
      text += name + "\r\n";
    }
    return folder_.file("list.txt", text);
  }
  std::set<std::string> files_in(const std::string& folder) const {
    std::set<std::string> names;
    std::error_code error;
    for (const auto& file : std::filesystem::directory_iterator(folder_ / folder, error))
      names.insert(file.path().filename().string());
    return names;
  }
  /// The file of an object, which has been read or not.
  static std::string file_of(const nlohmann::json& object) {
    return object[object.contains("error") ? "files" : "models"][0];
  }
  static std::vector<nlohmann::json> objects_of(const std::string& output) {
    std::vector<nlohmann::json> objects;
    std::istringstream text(output);
    for (std::string line; std::getline(text, line);) objects.push_back(nlohmann::json::parse(line));
    return objects;
  }
};

TEST_F(Batch, FilesOfAListAreThoseOfSingleRuns) {
  list_of(9);
  const std::vector<nlohmann::json> objects =
      objects_of(output_of({"tessellate", "--list", "list.txt", "-o", "out/", "--threads", "3", "--json"}));
  EXPECT_EQ(objects.size(), 9u);
  EXPECT_EQ(files_in("out").size(), 9u);
  output_of({"tessellate", "m4.json", "-o", "alone.ply"});
  EXPECT_EQ(content_of(folder_ / "out/m4.ply"), content_of(folder_ / "alone.ply"));
}

TEST_F(Batch, ShardsTakeEachFileOnce) {
  list_of(7);
  std::size_t count = 0;
  for (const std::string shard : {"1/3", "2/3", "3/3"})
    count += objects_of(output_of({"convert", "--list", "list.txt", "--shard", shard, "-o", "out/", "--json"})).size();
  EXPECT_EQ(count, 7u);
  EXPECT_EQ(files_in("out").size(), 7u);
}

TEST_F(Batch, FailuresAreNamedAndOthersGoOn) {
  const std::string list = list_of(3);
  folder_.file("broken.json", "{");
  std::ofstream(list, std::ios::app) << "missing.json\nbroken.json\n";
  const std::vector<std::string> command{"tessellate", "--list", "list.txt", "-o", "out/", "--json", "--keep-going"};
  const ToolRun result = run(command);
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.errors.find("missing.json: cannot be opened"), std::string::npos) << result.errors;
  EXPECT_NE(result.errors.find("broken.json:1: "), std::string::npos) << result.errors;
  std::map<std::string, bool> failed;
  for (const nlohmann::json& object : objects_of(result.output)) failed[file_of(object)] = object.contains("error");
  EXPECT_EQ(failed.size(), 5u);
  EXPECT_TRUE(failed["missing.json"] && failed["broken.json"]);
  EXPECT_EQ(files_in("out").size(), 3u);
  // Without --keep-going no file is begun after one has failed.
  folder_.file("bad_first.txt", "broken.json\nm0.json\nm1.json\nm2.json\n");
  EXPECT_EQ(run({"tessellate", "--list", "bad_first.txt", "-o", "none/", "--threads", "1"}).status, 1);
  EXPECT_TRUE(files_in("none").empty());
}

TEST_F(Batch, ResumePassesOverWhatIsDone) {
  list_of(4);
  const std::vector<std::string> command{"tessellate", "--list", "list.txt", "-o", "out/", "--json", "--resume"};
  EXPECT_EQ(objects_of(output_of(command)).size(), 4u);
  EXPECT_EQ(output_of(command), "");
  std::filesystem::remove(folder_ / "out/m1.ply");
  std::filesystem::copy_file(TESSERA_SOURCE_DIR "/tools/models/bezier_twists.json", folder_ / "m2.json",
                             std::filesystem::copy_options::overwrite_existing);
  std::ofstream(folder_ / "list.txt.1-of-1.done", std::ios::app) << "0123456789abcdef01";  // cut off
  std::set<std::string> again;
  for (const nlohmann::json& object : objects_of(output_of(command))) again.insert(file_of(object));
  EXPECT_EQ(again, (std::set<std::string>{"m1.json", "m2.json"}));
  EXPECT_EQ(output_of(command), "");
  std::vector<std::string> finer = command;
  finer.insert(finer.end(), {"--relative", "1e-4"});
  EXPECT_EQ(objects_of(output_of(finer)).size(), 4u);
}

TEST_F(Batch, ResumeAfterAKillLosesNothing) {
  list_of(200);
  const std::vector<std::string> command{TESSERA_TOOL, "tessellate", "--list", "list.txt", "-o", "out/", "--resume"};
  {
    RunningProgram running(folder_, command);
    while (files_in("out").size() < 5) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    running.signal(SIGKILL);
    running.wait();
  }
  EXPECT_LT(files_in("out").size(), 200u);
  EXPECT_EQ(run_program(folder_, command).status, 0);
  std::size_t meshes = 0;
  for (const std::string& name : files_in("out")) meshes += name.ends_with(".ply");
  EXPECT_EQ(meshes, 200u);
}

TEST_F(Batch, AFileThatHangsEndsAtTheTimeout) {
  list_of(2);
  ASSERT_EQ(::mkfifo((folder_ / "pipe.json").c_str(), 0600), 0);  // nobody writes to it
  folder_.file("slow.txt", "m0.json\npipe.json\nm1.json\n");
  const ToolRun result =
      run({"tessellate", "--list", "slow.txt", "-o", "out/", "--timeout", "0.3", "--keep-going", "--threads", "1"});
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(result.errors, "tessera: pipe.json: took longer than 0.3 s (--timeout)\n");
  EXPECT_EQ(files_in("out"), (std::set<std::string>{"m0.ply", "m1.ply"}));
}

TEST_F(Batch, AFileThatTakesTooMuchMemoryFailsAlone) {
  list_of(1);
  folder_.file("large.txt", "m0.json\n");
  const ToolRun result =
      run({"tessellate", "--list", "large.txt", "-o", "out/", "--memory-per-file", "20M", "--relative", "1e-6"});
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(result.errors, "tessera: m0.json: takes more memory than there is, or --memory-per-file allows\n");
  EXPECT_TRUE(files_in("out").empty());
}

TEST_F(Batch, WrongOptionsAreSaid) {
  list_of(2);
  expect_failure({"tessellate", "--list", "list.txt", "-o", "one.ply"}, 2, "tessera: --output: needs a place for each");
  expect_failure({"info", "--list", "none.txt"}, 2, "tessera: --list: none.txt: cannot be opened");
  expect_failure({"info", "--list", "list.txt", "--shard", "3/2"}, 2,
                 "tessera: --shard: expected K/N with 1 <= K <= N");
  expect_failure({"info", "m0.json", "--resume"}, 2, "tessera: --resume: needs --list FILE");
}

}  // namespace
}  // namespace tessera::test
