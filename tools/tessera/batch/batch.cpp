#include "batch/batch.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <thread>
#include <utility>

#include "batch/kept.h"
#include "batch/workers.h"
#include "console/console.h"
#include "console/memory.h"
#include "tessera/io.h"
#include "tessera/version.h"

namespace tessera::cli {
namespace {

namespace fs = std::filesystem;

/// Two hashes of 64 bits by FNV-1a, from different starts.
struct InputHash {
  std::uint64_t first = 0xcbf29ce484222325u, second = 0x84222325cbf29ce4u;

  void add(std::string_view bytes) {
    for (const char byte : bytes) {
      first = (first ^ static_cast<unsigned char>(byte)) * 0x100000001b3u;
      second = (second ^ static_cast<unsigned char>(byte)) * 0x100000001b3u;
    }
  }
  /// Adds a file by its parts, so that its size needs no memory. Returns whether all could be read.
  bool add_file(const std::string& name) {
    std::error_code error;
    if (!fs::is_regular_file(name, error)) return false;
    std::ifstream file(name, std::ios::binary);
    std::vector<char> part(std::size_t{1} << 16);
    while (file.read(part.data(), static_cast<std::streamsize>(part.size())), file.gcount() > 0 && !interrupted())
      add({part.data(), static_cast<std::size_t>(file.gcount())});
    return file.eof();
  }
};

/// Names a job by what decides its result: 128 bits in hexadecimal digits; empty if a file cannot be read, or is a
/// pipe.
std::string key_of(const Job& job, const CommonOptions& options) {
  InputHash hash;
  hash.add(TESSERA_VERSION "\n");
  for (const std::string& word : options.words) hash.add(word + '\n');
  for (const std::string& input : job.inputs) {
    hash.second = ~hash.second;
    hash.add(input);
    if (!hash.add_file(input)) return {};
  }
  char digits[33];
  std::snprintf(digits, sizeof digits, "%016llx%016llx", static_cast<unsigned long long>(hash.first),
                static_cast<unsigned long long>(hash.second));
  return digits;
}

/// The record of what is done: a line "KEY FILE" for each file, appended as a whole.
class Record {
 public:
  explicit Record(const BatchOptions& options)
      : path_(options.list + "." + std::to_string(options.shard.first) + "-of-" + std::to_string(options.shard.second) +
              ".done") {}

  /// Reads what is done, or begins anew. Errors: io_error.
  Status open(bool resume) {
    if (resume) {
      std::ifstream file(path_);
      for (std::string line; std::getline(file, line);)  // a last line that was cut off matches nothing
        if (line.size() > key_size && line[key_size] == ' ') done_.insert(line.substr(0, key_size));
    }
    if (!resume) std::ofstream(path_, std::ios::trunc);
    file_.open(path_, std::ios::app);                  // so that two runs of a shard do not write over each other
    if (file_ && resume) file_ << '\n' << std::flush;  // ends such a line
    return written();
  }
  bool has(const std::string& key) const { return !key.empty() && done_.contains(key); }
  /// Errors: io_error.
  Status add(const std::string& key, const Job& job) {
    if (!key.empty()) file_ << key + " " + job.inputs[0] + "\n" << std::flush;
    return written();
  }

 private:
  Status written() const {
    return file_ ? Status() : Status(StatusCode::io_error, path_ + ": cannot be written: " + std::strerror(errno));
  }

  static constexpr std::size_t key_size = 32;
  std::string path_;
  std::set<std::string> done_;
  std::ofstream file_;
};

bool is_there(const Job& job) {
  std::error_code error;
  return job.output.empty() || fs::exists(job.output, error);
}

/// Prints what a job has printed, or why it failed.
Status report(const Job& job, const JobResult& result, const CommonOptions& options) {
  if (!result.output.empty())
    if (Status status = print(result.output); !status.ok()) return status;
  if (result.status.ok() || is_already_said(result.status)) return {};
  const bool lacks_memory = result.status.code() == StatusCode::out_of_memory;
  const Status status =
      lacks_memory       ? in_file(job.inputs[0], Status(StatusCode::out_of_memory,
                                                         "takes more memory than there is, or --memory-per-file allows"))
      : result.has_ended ? in_file(job.inputs[0], result.status)
                         : result.status;
  complain(status.message());
  return options.json ? print_json(error_json(job, status)) : Status();
}

}  // namespace

void add_batch(Command& command, BatchOptions& options) {
  command.option("MODEL").required = false;  // append_listed() checks it
  command.begin_group("Many files");
  const Option& list =
      command
          .add_text("--list", "FILE", "A file that names more files, a line each, for worker processes (--threads)",
                    options.list)
          .check(fault_of_name);
  command
      .add("--shard", "K/N", "Take every N-th file of the list, from the K-th on: one of N machines or jobs [1/1]",
           [&options](const std::string& text) { options.shard = parse_shard(text); })
      .need(list);
  command
      .add_flag("--resume", "Pass over what the record LIST.K-of-N.done says is done with these options",
                options.resume)
      .need(list);
  command.add_flag("--keep-going", "Go on with other files after one has failed", options.keep_going).need(list);
  command
      .add_length("--timeout", "SECONDS", "The longest time for one file [none]",
                  [&options](double seconds) { options.timeout = seconds; })
      .need(list);
  command
      .add("--memory-per-file", "SIZE", "The most memory for one file, like 800M or 2G [no limit]",
           [&options](const std::string& text) { options.memory = parse_bytes("--memory-per-file", text); })
      .need(list);
}

Shard parse_shard(const std::string& text) {
  Shard shard;
  const char* const end = text.data() + text.size();
  const auto [slash, fault] = std::from_chars(text.data(), end, shard.first);
  const bool has_both =
      fault == std::errc() && slash != end && *slash == '/' && std::from_chars(slash + 1, end, shard.second).ptr == end;
  if (!has_both || shard.first < 1 || shard.first > shard.second)
    throw UsageError("--shard", "expected K/N with 1 <= K <= N, found \"" + text + "\"");
  return shard;
}

void check_batch(const BatchOptions& options, const Plan& plan) {
  if (!options.list.empty() && plan.jobs.size() == 1 && plan.jobs[0].inputs.size() > 1)
    throw UsageError("--output", "needs a place for each file of --list: a folder, or a name with {name}");
}

std::vector<std::string> result_words(int argc, const char* const* argv) {
  constexpr std::string_view flags[] = {"--resume", "--keep-going", "--timings"};
  constexpr std::string_view with_value[] = {"--list", "--shard", "--timeout", "--memory-per-file", "--threads"};
  std::vector<std::string> words;
  for (int k = 1; k < argc; ++k) {
    const std::string_view word = argv[k];
    if (word == "--") {  // files follow
      words.insert(words.end(), argv + k, argv + argc);
      break;
    }
    if (std::ranges::find(flags, word) != std::end(flags)) continue;
    if (std::ranges::find(with_value, word) != std::end(with_value)) {
      ++k;
      continue;
    }
    const auto has_prefix = [&](std::string_view option) { return word.starts_with(std::string(option) + "="); };
    if (std::ranges::none_of(with_value, has_prefix)) words.emplace_back(word);
  }
  return words;
}

std::vector<std::string> listed_files(const BatchOptions& options, const std::vector<std::string>& files) {
  std::vector<std::string> listed;
  if (options.list.empty()) {
    if (files.empty()) throw UsageError("MODEL", "expected files or --list FILE, found none");
    return listed;
  }
  const Result<std::string> text = read_file(options.list);
  if (!text) throw UsageError("--list", text.status().message());
  for (std::size_t begin = 0; begin < text->size();) {
    const std::size_t end = std::min(text->find('\n', begin), text->size());
    std::string line = text->substr(begin, end - begin);
    begin = end + 1;
    if (line.ends_with('\r')) line.pop_back();
    if (!line.empty() && !line.starts_with('#')) listed.push_back(line);
  }
  return listed;
}

Status run_batch(const Plan& plan, const CommonOptions& options,
                 const std::function<Status(const Job&, Timings&)>& work) {
  const BatchOptions& batch = options.batch;
  Record record(batch);
  if (Status status = record.open(batch.resume); !status.ok()) return status;
  Status failure;
  bool is_stopped = false;
  const auto done = [&](const Job& job, const JobResult& result) {
    Status said = report(job, result, options);  // before the record: a kill in between loses no result
    if (said.ok() && result.status.ok()) said = record.add(result.note, job);
    if (!result.status.ok()) failure = already_said(result.status.code());
    is_stopped = is_stopped || !said.ok() || (!result.status.ok() && !batch.keep_going);
    if (!said.ok()) failure = said;
  };
  for (const std::string& pattern : plan.unmatched) {
    JobResult result;
    result.status = Status(StatusCode::io_error, pattern + ": expected files that match, found none");
    done({{pattern}, {}}, result);
  }
  const auto count = static_cast<std::size_t>(batch.shard.second);
  const auto next = [&, k = static_cast<std::size_t>(batch.shard.first) - 1]() mutable -> std::optional<std::size_t> {
    if (k >= plan.jobs.size() || is_stopped || interrupted()) return {};
    return std::exchange(k, k + count);
  };
  const auto threads = options.threads > 0 ? static_cast<std::size_t>(options.threads)
                                           : std::max(1u, std::thread::hardware_concurrency());
  const Status status = run_workers(
      {.workers = std::min(threads, plan.jobs.size()), .timeout = batch.timeout, .memory = batch.memory}, next,
      [&](std::size_t k, std::string& key) {
        key = key_of(plan.jobs[k], options);
        if (record.has(key) && is_there(plan.jobs[k])) return key.clear(), Status();
        Timings timings;
        const Status own = work(plan.jobs[k], timings);
        drop_kept();
        return own;
      },
      [&](std::size_t k, const JobResult& result) { done(plan.jobs[k], result); });
  return status.ok() ? failure : status;
}

}  // namespace tessera::cli
