#include <algorithm>
#include <string>
#include <system_error>
#include <thread>

#include "base/text.h"
#include "io/file/output_file.h"
#include "parts/checksum.h"
#include "parts/message_file.h"
#include "tessera/guard.h"
#include "tessera/io.h"
#include "tessera/transport.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

std::string padded(std::uint64_t number) {
  const std::string digits = std::to_string(number);
  return std::string(digits.size() < 6 ? 6 - digits.size() : 0, '0') + digits;
}

class JobTransport final : public Transport {
 public:
  JobTransport(JobFolder options, std::size_t part, std::size_t part_count, std::uint64_t run)
      : Transport(part, part_count), options_(std::move(options)), run_(run) {}

 private:
  Result<std::vector<Message>> exchange_messages(std::vector<Message> messages) override {
    return meet(std::move(messages), false);
  }
  Result<SharedMessages> share_message(Message message) override {
    std::vector<Message> one;
    one.push_back(std::move(message));
    Result<std::vector<Message>> all = meet(std::move(one), true);
    if (!all) return all.status();
    return SharedMessages(std::make_shared<const std::vector<Message>>(*std::move(all)));
  }

  /// Writes this part's messages, and waits for those of all others.
  Result<std::vector<Message>> meet(std::vector<Message> messages, bool shared) {
    MessageFileKey key{run_, part_count(), call_++, part(), shared};
    if (Status status = write_messages(file_of(key), key, messages); !status.ok()) return status;
    Message own = std::move(messages[shared ? 0 : part()]);
    std::vector<Message>().swap(messages);
    messages.resize(part_count());
    messages[part()] = std::move(own);
    const Clock::time_point begin = Clock::now();
    for (key.from = 0; key.from < part_count(); ++key.from) {
      if (key.from == part()) continue;
      Result<Message> message = wait_for(key, begin);
      if (!message) return message.status();
      messages[key.from] = *std::move(message);
    }
    return messages;
  }

  Result<Message> wait_for(const MessageFileKey& key, Clock::time_point begin) const {
    const fs::path file = file_of(key);
    for (;;) {
      const bool is_late = Clock::now() - begin >= options_.wait;  // before the last look
      Result<std::optional<Message>> message = read_message(file, key, part());
      if (!message) return message.status();
      if (*message) return **std::move(message);
      const bool is_cancelled = options_.cancel && options_.cancel->load();
      if (is_cancelled) return Status(StatusCode::cancelled, "cancelled by the caller");
      if (is_late)
        return Status(StatusCode::cancelled, "part " + std::to_string(part()) + ": has waited for part " +
                                                 std::to_string(key.from) + " for " + seconds() + ": " + file.string() +
                                                 " is missing. Start it again once that part runs");
      std::this_thread::sleep_for(options_.look_every);
    }
  }

  std::string seconds() const { return counted(static_cast<std::size_t>(options_.wait.count()), "second"); }
  fs::path file_of(const MessageFileKey& key) const {
    return options_.folder / ("call-" + padded(key.call) + ".part-" + padded(key.from) + ".messages");
  }

  JobFolder options_;
  std::uint64_t run_ = 0, call_ = 0;
};

/// Writes the file that says which run has the folder, or reads that it is this one. If two runs write it at once, the
/// heads of their messages tell.
Status take_folder(const JobFolder& options, std::size_t part_count, std::uint64_t run) {
  std::error_code error;
  fs::create_directories(options.folder, error);
  if (error) return Status(StatusCode::io_error, options.folder.string() + ": cannot be made: " + error.message());
  const fs::path path = options.folder / "run.txt";
  const std::string text =
      "tessera messages 1\nparts " + std::to_string(part_count) + "\nrun " + std::to_string(run) + '\n';
  if (fs::exists(path, error)) {
    const Result<std::string> there = read_file(path);
    if (!there) return there.status();
    if (*there == text) return {};
    const std::size_t same = std::ranges::mismatch(*there, text).in1 - there->begin();
    const bool other_count = same < text.find("run");
    return Status(StatusCode::parse_error,
                  path.string() + ": is of a run with " +
                      (other_count ? "another number of parts" : "another input or other options") +
                      ". Empty the folder, or name another one");
  }
  Result<OutputFile> file = OutputFile::make(path);
  if (!file) return file.status();
  file->write(text);
  return file->commit();
}

}  // namespace

Result<std::unique_ptr<Transport>> make_job_transport(const JobFolder& options, std::size_t part,
                                                      std::size_t part_count, std::string_view run) {
  return guarded([&]() -> Result<std::unique_ptr<Transport>> {
    const auto bad = [](const std::string& why) { return Status(StatusCode::invalid_argument, why); };
    if (part >= part_count)
      return bad("part " + std::to_string(part) + " is none of " + counted(part_count, "part") + ", counted from 0");
    if (options.folder.empty()) return bad("JobFolder::folder is empty");
    if (options.wait.count() < 0) return bad("JobFolder::wait is negative");
    if (options.look_every.count() < 1) return bad("JobFolder::look_every is below 1 ms");
    const std::uint64_t hash = checksum(std::as_bytes(std::span(run)));
    if (Status status = take_folder(options, part_count, hash); !status.ok()) return status;
    return std::unique_ptr<Transport>(std::make_unique<JobTransport>(options, part, part_count, hash));
  });
}

}}  // namespace tessera::abi_0_1
