#include "parts/turns.h"

#include <string>

#include "parts/part_status.h"
#include "tessera/guard.h"

namespace tessera { inline namespace abi_0_1 {

void Turns::start(std::size_t count, Status fault) {
  const std::lock_guard lock(mutex_);
  for (std::size_t part = count; part < seats_.size(); ++part) seats_[part].state = State::ended;
  set_fault(std::move(fault));
  turn_ = seats_.size() - 1;
  pass_turn();
}

bool Turns::begin(std::size_t part) {
  std::unique_lock lock(mutex_);
  seats_[part].turn.wait(lock, [&] { return turn_ == part; });
  return fault_.ok();
}

void Turns::end(std::size_t part, const Status& status) {
  const std::lock_guard lock(mutex_);
  seats_[part].state = State::ended;
  if (!status.ok()) set_fault(guarded([&] { return in_part(part, status); }));
  pass_turn();
}

Status Turns::fault() const {
  const std::lock_guard lock(mutex_);
  return fault_;
}

void Turns::set_fault(Status status) {
  if (fault_.ok()) fault_ = std::move(status);
}

/// Gives the turn to the next part that can run, round the table, so that finding it takes constant time.
void Turns::pass_turn() {
  for (int attempt = 0; attempt < 2; ++attempt) {
    for (std::size_t k = 1; k <= seats_.size(); ++k) {
      const std::size_t part = (turn_ + k) % seats_.size();
      if (!can_run(seats_[part])) continue;
      turn_ = part;
      seats_[part].turn.notify_one();
      return;
    }
    find_lost_part();
  }
}

/// Nobody can run. If parts wait, then for one that has ended.
void Turns::find_lost_part() {
  std::size_t waiting = seats_.size(), lost = seats_.size();
  for (std::size_t part = seats_.size(); part-- > 0;) (seats_[part].state == State::met ? waiting : lost) = part;
  if (waiting == seats_.size() || lost == seats_.size()) return;
  set_fault(guarded([&] {
    return Status(StatusCode::io_error, "part " + std::to_string(waiting) + ": waits for messages of part " +
                                            std::to_string(lost) + ", which has ended");
  }));
}

/// All parts must make the same call.
Status Turns::check_meeting(std::size_t part, Meeting meeting) {
  if (!fault_.ok()) return fault_;
  if (met_ == 0) first_met_ = part, meeting_ = meeting;
  if (meeting == meeting_) return {};
  return Status(StatusCode::invalid_argument,
                "makes another call than part " + std::to_string(first_met_) + ", though all must make the same");
}

/// Waits until all have met and this part has its turn again. Errors: the fault, unless all have met before it.
Status Turns::meet(std::size_t part, std::unique_lock<std::mutex>& lock) {
  const std::size_t meeting = meetings_;
  seats_[part].state = State::met;
  if (++met_ == seats_.size()) {
    for (Seat& seat : seats_) seat.state = State::ready;
    met_ = 0;
    ++meetings_;
  }
  pass_turn();
  seats_[part].turn.wait(lock, [&] { return turn_ == part; });
  return meetings_ > meeting ? Status() : fault_;
}

Result<std::vector<Message>> Turns::exchange(std::size_t part, std::vector<Message> messages) {
  std::unique_lock lock(mutex_);
  if (Status status = check_meeting(part, Meeting::exchange); !status.ok()) return status;
  const std::size_t now = meetings_ % 2;
  for (std::size_t to = 0; to < seats_.size(); ++to)
    if (!messages[to].empty()) seats_[to].inbox[now].push_back({part, std::move(messages[to])});
  std::vector<Message>().swap(messages);
  if (Status status = meet(part, lock); !status.ok()) return status;
  std::vector<Mail> inbox;
  inbox.swap(seats_[part].inbox[now]);
  messages.resize(seats_.size());
  for (Mail& mail : inbox) messages[mail.from] = std::move(mail.message);
  return messages;
}

Result<Turns::SharedMessages> Turns::share(std::size_t part, Message message) {
  std::unique_lock lock(mutex_);
  if (Status status = check_meeting(part, Meeting::share); !status.ok()) return status;
  const std::size_t now = meetings_ % 2;
  if (met_ == 0) shared_[now] = std::make_shared<std::vector<Message>>(seats_.size());
  const std::shared_ptr<std::vector<Message>> all = shared_[now];
  (*all)[part] = std::move(message);
  if (Status status = meet(part, lock); !status.ok()) return status;
  return SharedMessages(all);
}

}}  // namespace tessera::abi_0_1
