#pragma once
// Parts of one process that take turns: who runs, and the messages that wait.

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "tessera/status.h"
#include "tessera/transport.h"

namespace tessera { inline namespace abi_0_1 {

/// Lets one part run at a time. A part runs until it meets the others or ends; then the next one runs that can. When
/// all have met, each takes what others left for it.
///
/// An error of a part, or a part that ends while others wait for it, is the fault of all: meetings return it.
///
/// Threads: one for each part.
class Turns {
 public:
  using SharedMessages = std::shared_ptr<const std::vector<Message>>;

  explicit Turns(std::size_t count) : seats_(count) {}

  /// Gives the first part its turn. Call once, when there are threads for all parts below `count`; the others never
  /// begin.
  void start(std::size_t count, Status fault);
  /// Waits for the part's first turn. Returns whether it may run.
  bool begin(std::size_t part);
  /// Leaves one message for each part, meets all, and takes those for this part. Errors: the fault.
  Result<std::vector<Message>> exchange(std::size_t part, std::vector<Message> messages);
  /// Shows one message to all, meets them, and returns theirs. Errors: the fault.
  Result<SharedMessages> share(std::size_t part, Message message);
  /// Ends a part with its status.
  void end(std::size_t part, const Status& status);
  /// Returns the first error; success while there is none.
  Status fault() const;

 private:
  enum class State : std::uint8_t { ready, met, ended };
  enum class Meeting : std::uint8_t { exchange, share };
  struct Mail {
    std::size_t from;
    Message message;
  };
  struct Seat {
    std::condition_variable turn;
    State state = State::ready;
    std::vector<Mail> inbox[2];  ///< of even and of odd meetings: some parts are one ahead
  };

  Status check_meeting(std::size_t part, Meeting meeting);
  Status meet(std::size_t part, std::unique_lock<std::mutex>& lock);
  void set_fault(Status status);
  void pass_turn();
  void find_lost_part();
  bool can_run(const Seat& seat) const {
    return seat.state == State::ready || (seat.state == State::met && !fault_.ok());
  }

  mutable std::mutex mutex_;
  std::vector<Seat> seats_;
  std::shared_ptr<std::vector<Message>> shared_[2];
  std::size_t turn_ = ~std::size_t{0};
  std::size_t met_ = 0, first_met_ = 0, meetings_ = 0;
  Meeting meeting_ = Meeting::exchange;
  Status fault_;
};

}}  // namespace tessera::abi_0_1
