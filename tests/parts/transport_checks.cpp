#include "parts/transport_checks.h"

#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

namespace tessera::test {

Status wrong(const std::string& what) { return {StatusCode::internal, "wrong: " + what}; }

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double nan_number = std::numeric_limits<double>::quiet_NaN();

/// The message of part `from` to part `to` in a round: often nothing, now and then a megabyte.
Message sample(std::size_t from, std::size_t to, std::size_t round) {
  const std::size_t mix = from * 31 + to * 17 + round * 7;
  const std::size_t size = mix % 3 == 0 ? 0 : mix % 23 == 1 ? (std::size_t{1} << 20) + mix : mix;
  Message message(size);
  for (std::size_t k = 0; k < size; ++k) message[k] = static_cast<std::byte>(k * 7 + mix);
  return message;
}

Status check_exchange(Transport& transport) {
  const std::size_t own = transport.part(), count = transport.part_count();
  std::uint64_t sent = transport.bytes_sent(), taken = transport.bytes_taken();
  for (std::size_t round = 0; round < 5; ++round) {
    std::vector<Message> messages(count);
    for (std::size_t to = 0; to < count; ++to) {
      messages[to] = sample(own, to, round);
      if (to != own) sent += messages[to].size();
    }
    const Result<std::vector<Message>> all = transport.exchange(std::move(messages));
    if (!all) return all.status();
    if (all->size() != count) return wrong("the number of messages");
    for (std::size_t from = 0; from < count; ++from) {
      if ((*all)[from] != sample(from, own, round)) return wrong("the message of part " + std::to_string(from));
      if (from != own) taken += (*all)[from].size();
    }
  }
  return transport.bytes_sent() == sent && transport.bytes_taken() == taken ? Status() : wrong("the bytes counted");
}

Status check_empty_messages(Transport& transport) {
  const auto all = transport.exchange(std::vector<Message>(transport.part_count()));
  if (!all) return all.status();
  for (const Message& message : *all)
    if (!message.empty()) return wrong("an empty message has bytes");
  if (Status status = transport.reduce_max({}); !status.ok()) return status;
  const auto sums = transport.prefix_sum({});
  if (!sums) return sums.status();
  if (!sums->empty()) return wrong("sums of nothing");
  return transport.bytes_sent() == 0 && transport.bytes_taken() == 0 ? Status() : wrong("the bytes counted");
}

Status check_reduce_max(Transport& transport) {
  const auto own = static_cast<double>(transport.part()), count = static_cast<double>(transport.part_count());
  const bool is_first = own == 0, is_last = own == count - 1;
  double values[] = {own,
                     -own,
                     is_last ? -0.5 : -infinite,
                     is_first ? nan_number : infinite,
                     is_last ? 0.0 : -0.0,
                     -0.0,
                     is_last ? std::bit_cast<double>(0xFFF8000000000123u) : 7};
  if (Status status = transport.reduce_max(values); !status.ok()) return status;
  const double expected[] = {count - 1, -0.0, -0.5, nan_number, 0.0, -0.0, nan_number};
  for (std::size_t k = 0; k < std::size(values); ++k)
    if (std::bit_cast<std::uint64_t>(values[k]) != std::bit_cast<std::uint64_t>(expected[k]))
      return wrong("the largest number " + std::to_string(k) + " is " + std::to_string(values[k]));
  std::vector<double> many(100'000, own);
  if (Status status = transport.reduce_max(many); !status.ok()) return status;
  return many == std::vector<double>(many.size(), count - 1) ? Status() : wrong("the largest of many numbers");
}

Status check_prefix_sum(Transport& transport) {
  const std::uint64_t own = transport.part(), count = transport.part_count(), most = ~std::uint64_t{0};
  std::uint64_t values[] = {own + 1, 1, most};
  const auto sums = transport.prefix_sum(values);
  if (!sums) return sums.status();
  const std::vector<std::uint64_t> lower{own * (own + 1) / 2, own, 0 - own},
      all{count * (count + 1) / 2, count, 0 - count};
  if (!std::equal(lower.begin(), lower.end(), std::begin(values))) return wrong("the sums of lower parts");
  return *sums == all ? Status() : wrong("the sums of all parts");
}

Status check_agree(Transport& transport) {
  const std::size_t own = transport.part(), count = transport.part_count();
  if (Status status = transport.agree({}); !status.ok()) return status;
  for (std::size_t failing = 0; failing < count; ++failing) {
    Status mine;
    if (own >= failing) mine = Status(StatusCode::non_finite, "no number " + std::to_string(own), 7);
    const Status status = transport.agree(mine);
    if (status.code() != StatusCode::non_finite || status.index() != 7) return wrong("the code that parts agree on");
    if (status.message() != "part " + std::to_string(failing) + ": no number " + std::to_string(failing))
      return wrong("the message that parts agree on: " + status.message());
    const Status again = transport.agree(status);
    if (again.message() != status.message()) return wrong("an error that names a part gets another name");
  }
  return transport.agree({});
}

Status check_wrong_number_of_messages(Transport& transport) {
  const auto all = transport.exchange(std::vector<Message>(transport.part_count() + 1));
  if (all || all.status().code() != StatusCode::count_mismatch) return wrong("a message for nobody is taken");
  const Status later = transport.agree({});
  return later.message() == all.status().message() ? Status() : wrong("an error is not returned again");
}

Status check_unequal_lengths(Transport& transport) {
  std::vector<double> values(transport.part() == 0 ? 1 : 2);
  const Status status = transport.reduce_max(values);
  const bool is_wrong = transport.part_count() > 1;
  if (status.ok() == is_wrong) return wrong("lists of different lengths");
  return !is_wrong || status.code() == StatusCode::count_mismatch ? Status() : wrong("the code: " + status.message());
}

}  // namespace

const std::vector<TransportCheck> transport_checks{
    {"EmptyMessages", check_empty_messages},  // first: it expects that nothing was sent before
    {"Exchange", check_exchange},
    {"ReduceMax", check_reduce_max},
    {"PrefixSum", check_prefix_sum},
    {"Agree", check_agree},
    {"WrongNumberOfMessages", check_wrong_number_of_messages},
    {"UnequalLengths", check_unequal_lengths},
};

}  // namespace tessera::test
