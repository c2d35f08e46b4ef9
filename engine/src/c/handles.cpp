#include "c/handles.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <mutex>
#include <new>
#include <utility>

#include "c/handle_bits.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

using Bits = HandleBits<std::uintptr_t>;

/// A slot's state, one word so that it changes at once: which object lies there, by number; the references that callers
/// own; and the calls that use it.
struct State {
  std::uint32_t round : 32;
  std::uint32_t owners : 16;
  std::uint32_t calls : 16;
};
static_assert(sizeof(State) == 8);
constexpr std::uint32_t max_count = 0xffff;

struct Slot {
  std::atomic<std::uint64_t> state = 0;
  std::shared_ptr<Object> object;
  std::uint32_t next_free = 0;

  /// Changes the state by change(State&), which returns whether it may be changed. `now`: as it is then.
  template <class Change>
  bool update(Change change, State& now) {
    std::uint64_t bits = state.load(std::memory_order_acquire);
    for (;;) {
      now = std::bit_cast<State>(bits);
      if (!change(now)) return false;
      if (state.compare_exchange_weak(bits, std::bit_cast<std::uint64_t>(now), std::memory_order_acq_rel)) return true;
    }
  }
};

/// Slots never move and are never freed, so that stale handles can be looked up. They are reused in the order of their
/// release.
class Table {
 public:
  std::uintptr_t add(std::shared_ptr<Object> object) {
    const std::lock_guard lock(mutex_);
    const std::uint32_t place = take();
    Slot& slot = *find(place);
    slot.object = std::move(object);
    State state = std::bit_cast<State>(slot.state.load());
    state.owners = 1;
    slot.state.store(std::bit_cast<std::uint64_t>(state), std::memory_order_release);
    return Bits::packed(place, state.round);
  }
  /// Frees a slot that nobody refers to any more.
  void remove(std::uint32_t place) {
    Slot& slot = *find(place);
    const std::shared_ptr<Object> object = std::move(slot.object);  // ends after the lock
    const std::lock_guard lock(mutex_);
    State state = std::bit_cast<State>(slot.state.load());
    ++state.round;
    slot.state.store(std::bit_cast<std::uint64_t>(state), std::memory_order_release);
    slot.next_free = 0;
    (last_free_ ? find(last_free_)->next_free : first_free_) = place;
    last_free_ = place;
  }
  Slot* find(std::uint32_t place) const {
    Slot* const chunk =
        place / chunk_size < chunks_.size() ? chunks_[place / chunk_size].load(std::memory_order_acquire) : nullptr;
    return chunk && place > 0 ? &chunk[place % chunk_size] : nullptr;
  }
  std::mutex& mutex() { return mutex_; }

 private:
  static constexpr std::uint32_t chunk_size = 1024, max_chunks = 16384;

  std::uint32_t take() {
    if (first_free_ != 0) {
      const std::uint32_t place = first_free_;
      first_free_ = find(place)->next_free;
      if (first_free_ == 0) last_free_ = 0;
      return place;
    }
    if (count_ / chunk_size == chunks_.size()) throw std::bad_alloc();
    std::atomic<Slot*>& chunk = chunks_[count_ / chunk_size];
    if (!chunk.load()) chunk.store(new Slot[chunk_size], std::memory_order_release);
    return count_++;
  }

  std::mutex mutex_;
  std::array<std::atomic<Slot*>, std::min(max_chunks, Bits::place_mask / chunk_size)> chunks_ = {};
  std::uint32_t count_ = 1;  // 0 is no place, so that no handle is a null pointer
  std::uint32_t first_free_ = 0, last_free_ = 0;
};

Table& table() {
  static Table& table = *new Table;  // never freed: handles may be released while the program ends
  return table;
}

std::uint32_t place_of(const void* handle) { return Bits::place(std::bit_cast<std::uintptr_t>(handle)); }

/// Changes the state of a handle's slot. Returns the slot; null if the handle is none, or may not be changed so.
template <class Change>
Slot* update(const void* handle, Change change, State& state) {
  Slot* const slot = table().find(place_of(handle));
  const auto checked = [&](State& of) {
    return Bits::is_of_round(std::bit_cast<std::uintptr_t>(handle), of.round) && of.owners > 0 && change(of);
  };
  return slot && slot->update(checked, state) ? slot : nullptr;
}

}  // namespace

void* add_handle(std::shared_ptr<Object> object) { return std::bit_cast<void*>(table().add(std::move(object))); }

bool retain_handle(const void* handle) {
  State state;
  return update(
             handle, [](State& of) { return of.owners < max_count && (++of.owners, true); }, state) != nullptr;
}

bool release_handle(const void* handle) {
  State state;
  if (!update(
          handle, [](State& of) { return --of.owners, true; }, state))
    return false;
  if (state.owners == 0 && state.calls == 0) table().remove(place_of(handle));
  return true;
}

Pin::Pin(const void* handle) {
  State state;
  Slot* const slot = update(
      handle, [](State& of) { return of.calls < max_count && (++of.calls, true); }, state);
  if (!slot) return;
  place_ = place_of(handle);
  object_ = &slot->object;
}

Pin::~Pin() {
  if (!object_) return;
  State state;
  table().find(place_)->update([](State& of) { return --of.calls, true; }, state);
  if (state.owners == 0 && state.calls == 0) table().remove(place_);
}

void lock_handles() { table().mutex().lock(); }
void unlock_handles() { table().mutex().unlock(); }

}}  // namespace tessera::abi_0_1
