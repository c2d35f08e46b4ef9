// Many files from a list: worker processes, shards, what is done before, and files that fail, hang or take much memory.

#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <set>
#include <thread>

#include "tools/tool_test.h"

namespace tessera::test { namespace {

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
  /// Runs the tool on a list of three files, of which one is a pipe that nobody writes to, until all others are done;
  /// then calls `act`.
  template <class Act>
  ToolRun with_silent_file(Act&& act) {
    list_of(2);
    if (::mkfifo((folder_ / "pipe.json").c_str(), 0600) != 0) throw std::runtime_error("a pipe could not be made");
    folder_.file("silent.txt", "m0.json\nm1.json\npipe.json\n");
    RunningProgram tool(folder_, {TESSERA_TOOL, "tessellate", "--list", "silent.txt", "-o", "out/", "--json",
                                  "--keep-going", "--threads", "1"});
    const std::string record = folder_ / "silent.txt.1-of-1.done";
    const auto lines = [&] {
      const std::string text = std::filesystem::exists(record) ? content_of(record) : "";
      return std::count(text.begin(), text.end(), '\n');
    };
    while (lines() < 2) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    act(tool);
    return tool.wait();
  }
  /// The only child of a process; 0 if it has none.
  static pid_t worker_of(pid_t parent) {
    const std::string id = std::to_string(parent);
    std::ifstream children("/proc/" + id + "/task/" + id + "/children");
    pid_t child = 0;
    children >> child;
    return child;
  }
  static bool is_running(pid_t process) {
    std::ifstream stat("/proc/" + std::to_string(process) + "/stat");
    std::string id, name, state;
    return stat >> id >> name >> state && state != "Z";
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

TEST_F(Batch, ShardsMayWriteToOneFolderAtOnce) {
  list_of(60);
  std::vector<std::string> words{TESSERA_TOOL, "tessellate", "--list",    "list.txt", "-o",
                                 "made/out/",  "--json",     "--threads", "2",        "--shard"};
  const auto with = [&](const std::string& shard) {
    std::vector<std::string> command = words;
    command.push_back(shard);
    return command;
  };
  RunningProgram first(folder_, with("1/2")), second(folder_, with("2/2"));
  std::set<std::string> files;
  std::size_t count = 0;
  for (RunningProgram* shard : {&first, &second}) {
    const ToolRun result = shard->wait();
    EXPECT_EQ(result.status, 0) << result.errors;
    for (const nlohmann::json& object : objects_of(result.output)) files.insert(file_of(object)), ++count;
  }
  EXPECT_EQ(count, 60u);
  EXPECT_EQ(files.size(), 60u);
  EXPECT_EQ(files_in("made/out").size(), 60u);
}

TEST_F(Batch, FilesOfDifferentShardsCannotShareAnOutput) {
  list_of(2);
  std::filesystem::create_directory(folder_ / "other");
  std::filesystem::copy_file(folder_ / "m0.json", folder_ / "other/m0.json");
  folder_.file("same.txt", "m0.json\nother/m0.json\n");
  for (const std::string shard : {"1/2", "2/2"})
    expect_failure({"tessellate", "--list", "same.txt", "--shard", shard, "-o", "out/"}, 2,
                   "m0.json and other/m0.json would both be written as out/m0.ply");
}

TEST_F(Batch, NamesInAListAreNoPatterns) {
  list_of(2);
  std::filesystem::copy_file(folder_ / "m0.json", folder_ / "n[1].json");
  folder_.file("names.txt", "n[1].json\nm[01].json\n");
  const ToolRun result = run({"convert", "--list", "names.txt", "-o", "out/", "--keep-going"});
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.errors.find("m[01].json: cannot be opened"), std::string::npos) << result.errors;
  EXPECT_EQ(files_in("out"), std::set<std::string>{"n[1].obj"});
  // A pattern of the command line that matches nothing is an error beside a list, too.
  const ToolRun unmatched = run({"info", "x*.json", "--list", "list.txt"});
  EXPECT_EQ(unmatched.status, 1);
  EXPECT_EQ(unmatched.errors, "tessera: x*.json: expected files that match, found none\n");
  EXPECT_EQ(unmatched.output, "");  // no file is begun after one has failed
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
  const std::vector<std::string> command{TESSERA_TOOL, "tessellate", "--list",   "list.txt",
                                         "-o",         "out/",       "--resume", "--json"};
  std::set<std::string> files;
  std::size_t count = 0;
  const auto add = [&](const ToolRun& result) {
    for (const nlohmann::json& object : objects_of(result.output)) files.insert(file_of(object)), ++count;
  };
  for (const std::size_t done : {5u, 60u}) {
    RunningProgram running(folder_, command);
    while (files_in("out").size() < done) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    running.signal(SIGKILL);
    add(running.wait());
    EXPECT_LT(files_in("out").size(), 200u);
  }
  add(run_program(folder_, command));
  EXPECT_EQ(files.size(), 200u);
  EXPECT_LE(count, 202u);  // a kill between the report of a file and its record repeats it
  std::size_t meshes = 0;
  for (const std::string& name : files_in("out")) meshes += name.ends_with(".ply");
  EXPECT_EQ(meshes, 200u);
  std::set<std::string> recorded;
  std::ifstream record(folder_ / "list.txt.1-of-1.done");
  for (std::string line; std::getline(record, line);)
    EXPECT_TRUE(line.empty() || recorded.insert(line).second) << line << " is there twice";
  EXPECT_EQ(recorded.size(), 200u);
}

TEST_F(Batch, AWorkerThatIsKilledFailsItsFileAlone) {
  const ToolRun result = with_silent_file([](const RunningProgram& tool) { ::kill(worker_of(tool.id()), SIGKILL); });
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(result.errors, "tessera: pipe.json: the process that worked on it ended by signal Killed\n");
  EXPECT_TRUE(files_in("out").contains("m0.ply") && files_in("out").contains("m1.ply"));
  std::filesystem::remove(folder_ / "pipe.json");
  std::filesystem::copy_file(folder_ / "m0.json", folder_ / "pipe.json");
  const std::vector<nlohmann::json> again =
      objects_of(output_of({"tessellate", "--list", "silent.txt", "-o", "out/", "--json", "--resume"}));
  ASSERT_EQ(again.size(), 1u);
  EXPECT_EQ(file_of(again[0]), "pipe.json");
  EXPECT_EQ(files_in("out"), (std::set<std::string>{"m0.ply", "m1.ply", "pipe.ply"}));
}

TEST_F(Batch, WorkersEndWithAToolThatIsKilled) {
  pid_t worker = 0;
  const ToolRun result = with_silent_file([&](const RunningProgram& tool) {
    worker = worker_of(tool.id());
    tool.signal(SIGKILL);
  });
  EXPECT_EQ(result.status, 128 + SIGKILL);
  for (int k = 0; k < 10000 && is_running(worker); ++k) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_FALSE(is_running(worker));
}

TEST_F(Batch, AFullDiskFailsFilesAndSaysSo) {
  list_of(3);
  const std::vector<std::string> mesh{TESSERA_TOOL, "tessellate", "--list", "list.txt", "-o",
                                      "out/",       "--grid",     "64x64",  "--json",   "--keep-going",
                                      "--resume",   "--threads",  "1"};
  std::vector<std::string> limited{"sh", "-c", "ulimit -f 8 && exec \"$@\"", "sh"};
  limited.insert(limited.end(), mesh.begin(), mesh.end());
  const ToolRun result = run_program(folder_, limited);
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.errors.find("tessera: out/m1.ply: cannot be written: File too large\n"), std::string::npos)
      << result.errors;
  EXPECT_EQ(objects_of(result.output).size(), 3u);
  EXPECT_TRUE(files_in("out").empty());
  // Later, all are made.
  EXPECT_EQ(objects_of(run_program(folder_, mesh).output).size(), 3u);
  EXPECT_EQ(files_in("out").size(), 3u);
}

TEST_F(Batch, AnEndIsSaidIfResultsCannotBeRecorded) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  list_of(3);
  std::filesystem::create_symlink("/dev/full", folder_ / "list.txt.1-of-1.done");
  const ToolRun record = run({"convert", "--list", "list.txt", "-o", "out/", "--threads", "1", "--keep-going"});
  EXPECT_EQ(record.status, 1);
  EXPECT_EQ(record.errors, "tessera: list.txt.1-of-1.done: cannot be written: No space left on device\n");
  EXPECT_LE(files_in("out").size(), 2u);
  // A result that could not be printed is not done.
  std::filesystem::remove(folder_ / "list.txt.1-of-1.done");
  const ToolRun printed = run_program(folder_, {"sh", "-c", "exec \"$@\" >/dev/full", "sh", TESSERA_TOOL, "info",
                                                "--list", "list.txt", "--threads", "1"});
  EXPECT_EQ(printed.status, 1);
  EXPECT_NE(printed.errors.find("No space left on device"), std::string::npos) << printed.errors;
  EXPECT_EQ(content_of(folder_ / "list.txt.1-of-1.done"), "");
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

}}  // namespace tessera::test
