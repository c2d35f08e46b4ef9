#pragma once
// Messages between the parts of a model: parts that take turns in one process, independent jobs with a folder in
// common, the ranks of MPI (mpi.h), or a program's own way.

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// Bytes from one part to another.
using Message = std::vector<std::byte>;

/// Elements [begin, end) of a list.
struct PartRun {
  std::size_t begin = 0;  ///< the first
  std::size_t end = 0;    ///< behind the last
};

/// Returns a part's run of `count` elements. The runs of all parts cover the list in order, of nearly equal lengths.
/// Requires part < part_count.
PartRun run_of_part(std::size_t count, std::size_t part, std::size_t part_count);

/// One part's end of the lines to all parts.
///
/// All parts make the same calls in the same order, each a meeting of all. An error of a call, other than a status that
/// agree() passes on, ends the transport's use: each later call returns it again. Threads: one at a time. Implement
/// exchange_messages() for a transport of your own; the other calls rest on it.
class Transport {
 public:
  /// Requires part < part_count.
  Transport(std::size_t part, std::size_t part_count) : part_(part), part_count_(part_count) {}
  Transport(const Transport&) = delete;
  Transport& operator=(const Transport&) = delete;
  virtual ~Transport();

  std::size_t part() const { return part_; }                  ///< this part, below part_count()
  std::size_t part_count() const { return part_count_; }      ///< at least 1
  std::uint64_t bytes_sent() const { return bytes_sent_; }    ///< to other parts so far, by all calls
  std::uint64_t bytes_taken() const { return bytes_taken_; }  ///< from other parts so far, by all calls

  /// Sends messages[k] to part k, and returns the message of each part to this one, its own too.
  ///
  /// Errors: count_mismatch (not one message per part), io_error (a part that is lost; a file), parse_error (a file
  /// that is damaged, or of another run), invalid_argument (parts that make different calls), cancelled (a part that
  /// has waited too long), out_of_memory.
  Result<std::vector<Message>> exchange(std::vector<Message> messages);
  /// Replaces each value by the largest of all parts, who must give as many. NaN counts as the largest, and 0 is larger
  /// than -0: all parts get the same bits. Errors: as exchange(), count_mismatch.
  Status reduce_max(std::span<double> values);
  /// Replaces each value by the sum over the lower parts, and returns the sums over all, modulo 2^64. Errors: as
  /// exchange(), count_mismatch.
  Result<std::vector<std::uint64_t>> prefix_sum(std::span<std::uint64_t> values);
  /// Returns success if the status of every part is, else that of the lowest part with an error, as "part 3: ...", in
  /// every part. So all stop where one does, and may go on together. Errors: as exchange().
  Status agree(const Status& own);

 protected:
  /// A message of each part, for all.
  using SharedMessages = std::shared_ptr<const std::vector<Message>>;

  /// Does the work of exchange(), with one message for each part. Errors: those of exchange().
  virtual Result<std::vector<Message>> exchange_messages(std::vector<Message> messages) = 0;
  /// Gives one message to all parts, and returns the message of each. Replace it where there is a faster way than
  /// exchange_messages(). Errors: those of exchange().
  virtual Result<SharedMessages> share_message(Message message);
  /// Does the work of reduce_max(). Replace it where there is a faster way than share_message(). Errors: those of
  /// reduce_max().
  virtual Status reduce_values(std::span<double> values);

 private:
  template <class Call>
  auto until_fault(Call&& call) -> decltype(call());
  Result<SharedMessages> share(Message message);
  Result<std::vector<std::uint64_t>> add_lower(std::span<std::uint64_t> values);

  std::size_t part_, part_count_;
  std::uint64_t bytes_sent_ = 0, bytes_taken_ = 0;
  Status fault_;
};

/// The largest number of parts of run_parts().
inline constexpr std::size_t max_parts = 65536;

/// Runs a function once for each of `part_count` parts of this process. They take turns: one runs until it waits for
/// messages of others, so what a part does not hold while it waits need not fit into memory beside the others.
///
/// A part that ends early while others still wait for its messages is an error for these. When one returns an error,
/// all others get it from their next call, and parts that have not begun are not run.
///
/// Errors: the first of a part, as "part 3: ..."; invalid_argument (no parts, or more than max_parts), out_of_memory
/// (also threads). Memory: a message is moved from part to part; a part that waits keeps its stack. Threads: one for
/// each part, one of them running, with an arena as wide as the caller's.
Status run_parts(std::size_t part_count, const std::function<Status(Transport&)>& run);

/// How independent jobs wait for each other.
struct JobFolder {
  std::filesystem::path folder;               ///< common to all parts; made if it is missing
  std::chrono::seconds wait{600};             ///< for the messages of other parts, in each call; at least 0
  std::chrono::milliseconds look_every{20};   ///< at least 1 ms
  const std::atomic<bool>* cancel = nullptr;  ///< once true, waiting ends with cancelled
};

/// Makes the end of a job that sends messages by files in a folder, which it may share with jobs on other machines.
///
/// Jobs may begin at any time. A message is a file that gets its name when it is complete, and stays: a job that was
/// killed, or that has waited too long, can be started again and then finds the messages that others sent meanwhile. It
/// must do what it did before: a message that differs from the one that is there is an error. The folder must be empty
/// when the first job of a run begins, and can be removed when all have ended. It takes one file for each part and
/// call.
///
/// `run`: a text that all jobs of a run have in common, such as the input and its options.
///
/// Errors: invalid_argument (part or part_count; a time), io_error (the folder), parse_error (a folder of another
/// number of parts, or of another run), out_of_memory. Threads: any number of calls.
Result<std::unique_ptr<Transport>> make_job_transport(const JobFolder& options, std::size_t part,
                                                      std::size_t part_count, std::string_view run);

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
