#include <string>
#include <thread>
#include <vector>

#include "base/text.h"
#include "parallel/caller_arena.h"
#include "parts/turns.h"
#include "tessera/guard.h"
#include "tessera/transport.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The end of a part that takes turns with the others.
class TurnTransport final : public Transport {
 public:
  TurnTransport(Turns& turns, std::size_t part, std::size_t count) : Transport(part, count), turns_(turns) {}

 private:
  Result<std::vector<Message>> exchange_messages(std::vector<Message> messages) override {
    return turns_.exchange(part(), std::move(messages));
  }
  Result<SharedMessages> share_message(Message message) override { return turns_.share(part(), std::move(message)); }

  Turns& turns_;
};

}  // namespace

Status run_parts(std::size_t part_count, const std::function<Status(Transport&)>& run) {
  return guarded([&]() -> Status {
    if (part_count < 1 || part_count > max_parts)
      return Status(StatusCode::invalid_argument,
                    "there are " + counted(part_count, "part") + ", expected 1 to " + std::to_string(max_parts));
    Turns turns(part_count);
    const int width = arena_threads();
    const auto run_part = [&](std::size_t part) noexcept {
      Status status;
      if (turns.begin(part))
        status = guarded([&] {
          TurnTransport transport(turns, part, part_count);
          Status own;
          in_own_arena(width, [&] { own = run(transport); });
          return own;
        });
      turns.end(part, status);
    };
    std::vector<std::thread> threads;
    threads.reserve(part_count);
    Status fault;
    try {
      while (threads.size() < part_count) threads.emplace_back(run_part, threads.size());
    } catch (...) {
      fault = guarded([&] {
        return Status(StatusCode::out_of_memory,
                      "the system has threads for " + counted(threads.size(), "part") + " alone");
      });
    }
    turns.start(threads.size(), fault);
    for (std::thread& thread : threads) thread.join();
    return turns.fault();
  });
}

}}  // namespace tessera::abi_0_1
