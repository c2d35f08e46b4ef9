#include "tessera/transport.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <utility>

#include "base/text.h"
#include "parts/largest.h"
#include "parts/part_status.h"
#include "tessera/guard.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

template <class T>
Message message_of(std::span<const T> values) {
  const auto bytes = std::as_bytes(values);
  return {bytes.begin(), bytes.end()};
}

/// Copies a message into as many values. Errors: count_mismatch.
template <class T>
Status read(const Message& message, std::size_t part, std::span<T> values) {
  if (message.size() != values.size_bytes())
    return Status(StatusCode::count_mismatch, "part " + std::to_string(part) + " sent " +
                                                  counted(message.size(), "byte") + ", expected " +
                                                  std::to_string(values.size_bytes()));
  if (!values.empty()) std::memcpy(values.data(), message.data(), message.size());
  return {};
}

const Status& status_of(const Status& status) { return status; }
template <class T>
const Status& status_of(const Result<T>& result) {
  return result.status();
}

/// A status as bytes; empty for success.
Message message_of(const Status& status) {
  if (status.ok()) return {};
  const std::int64_t head[] = {static_cast<std::int64_t>(status.code()), status.index()};
  Message message = message_of(std::span<const std::int64_t>(head));
  const Message text = message_of(std::span<const char>(status.message()));
  message.insert(message.end(), text.begin(), text.end());
  return message;
}

Status status_of(const Message& message) {
  std::int64_t head[2];
  if (message.size() < sizeof(head)) return {};
  std::memcpy(head, message.data(), sizeof(head));
  std::string text(reinterpret_cast<const char*>(message.data()) + sizeof(head), message.size() - sizeof(head));
  return Status(static_cast<StatusCode>(head[0]), std::move(text), static_cast<std::ptrdiff_t>(head[1]));
}

}  // namespace

PartRun run_of_part(std::size_t count, std::size_t part, std::size_t part_count) {
  const std::size_t each = count / part_count, more = count % part_count;
  const auto begin = [&](std::size_t of) { return of * each + std::min(of, more); };
  return {begin(part), begin(part + 1)};
}

Transport::~Transport() = default;

/// Calls call() unless an earlier one has failed, and keeps its error.
template <class Call>
auto Transport::until_fault(Call&& call) -> decltype(call()) {
  return guarded([&]() -> decltype(call()) {
    if (!fault_.ok()) return fault_;
    auto result = guarded(call);
    if (!result.ok()) fault_ = status_of(result);
    return result;
  });
}

Result<std::vector<Message>> Transport::exchange(std::vector<Message> messages) {
  return until_fault([&]() -> Result<std::vector<Message>> {
    if (messages.size() != part_count_)
      return Status(StatusCode::count_mismatch,
                    "there are " + counted(messages.size(), "message") + " for " + counted(part_count_, "part"));
    for (std::size_t k = 0; k < part_count_; ++k)
      if (k != part_) bytes_sent_ += messages[k].size();
    Result<std::vector<Message>> taken = exchange_messages(std::move(messages));
    for (std::size_t k = 0; taken && k < part_count_; ++k)
      if (k != part_) bytes_taken_ += (*taken)[k].size();
    return taken;
  });
}

Result<Transport::SharedMessages> Transport::share_message(Message message) {
  Result<std::vector<Message>> all = exchange_messages(std::vector<Message>(part_count_, message));
  if (!all) return all.status();
  return SharedMessages(std::make_shared<const std::vector<Message>>(*std::move(all)));
}

Result<Transport::SharedMessages> Transport::share(Message message) {
  bytes_sent_ += message.size() * (part_count_ - 1);
  Result<SharedMessages> all = share_message(std::move(message));
  for (std::size_t k = 0; all && k < part_count_; ++k)
    if (k != part_) bytes_taken_ += (**all)[k].size();
  return all;
}

Status Transport::reduce_values(std::span<double> values) {
  const Result<SharedMessages> all = share(message_of(std::span<const double>(values)));
  if (!all) return all.status();
  std::vector<double> other(values.size());
  for (std::size_t part = 0; part < part_count_; ++part) {
    if (Status status = read((**all)[part], part, std::span(other)); !status.ok()) return status;
    for (std::size_t k = 0; k < values.size(); ++k) values[k] = larger_of(values[k], other[k]);
  }
  return {};
}

Status Transport::reduce_max(std::span<double> values) {
  return until_fault([&] { return reduce_values(values); });
}

Result<std::vector<std::uint64_t>> Transport::add_lower(std::span<std::uint64_t> values) {
  const Result<SharedMessages> all = share(message_of(std::span<const std::uint64_t>(values)));
  if (!all) return all.status();
  std::vector<std::uint64_t> other(values.size()), lower(values.size()), sums(values.size());
  for (std::size_t part = 0; part < part_count_; ++part) {
    if (part == part_) lower = sums;
    if (Status status = read((**all)[part], part, std::span(other)); !status.ok()) return status;
    for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += other[k];
  }
  std::ranges::copy(lower, values.begin());
  return sums;
}

Result<std::vector<std::uint64_t>> Transport::prefix_sum(std::span<std::uint64_t> values) {
  return until_fault([&] { return add_lower(values); });
}

Status Transport::agree(const Status& own) {
  const auto all = until_fault([&] { return share(message_of(own)); });
  if (!all) return all.status();
  return guarded([&]() -> Status {
    for (std::size_t part = 0; part < part_count_; ++part)
      if (const Status status = status_of((**all)[part]); !status.ok()) return in_part(part, status);
    return {};
  });
}

}}  // namespace tessera::abi_0_1
