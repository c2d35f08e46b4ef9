#pragma once
// Memory that many objects hold together.

#include <atomic>
#include <cstddef>
#include <new>
#include <utility>

#pragma GCC visibility push(default)
namespace tessera::inline abi_0_1 {

/// A handle on memory that is freed with the last of its handles. Unlike those of std::shared_ptr, handles can be made
/// and given up many at once by one change of their count: the pieces of one surface are ten thousands, and an atomic
/// operation each would cost as much as computing them. Threads: as std::shared_ptr.
class SharedMemory {
 public:
  SharedMemory() = default;
  /// The first handle on `bytes` of memory, unset. Throws std::bad_alloc.
  explicit SharedMemory(std::size_t bytes) : block_(::new (::operator new(sizeof(Block) + bytes)) Block) {}
  /// One more handle.
  SharedMemory(const SharedMemory& other) noexcept : block_(other.block_) {
    if (block_) block_->handles.fetch_add(1, std::memory_order_relaxed);
  }
  /// The same handle; the other one is empty.
  SharedMemory(SharedMemory&& other) noexcept : block_(std::exchange(other.block_, nullptr)) {}
  /// Gives up the handle that it was.
  SharedMemory& operator=(SharedMemory other) noexcept {
    std::swap(block_, other.block_);
    return *this;
  }
  ~SharedMemory() {
    if (block_) drop(block_, 1);
  }

  /// Whether there is no other handle on the memory. The handle is not empty.
  bool sole() const noexcept { return block_->handles.load(std::memory_order_acquire) == 1; }
  /// The first byte, aligned as operator new aligns. The handle is not empty.
  void* data() const { return block_ + 1; }

 private:
  struct alignas(__STDCPP_DEFAULT_NEW_ALIGNMENT__) Block {
    std::atomic<std::size_t> handles{1};
  };
  static void drop(Block* block, std::size_t count) noexcept {
    if (block->handles.fetch_sub(count, std::memory_order_acq_rel) != count) return;
    block->~Block();
    ::operator delete(block);
  }
  explicit SharedMemory(Block* block) : block_(block) {}

  Block* block_ = nullptr;

 public:
  /// `count` more handles on the memory of `one`, counted at once.
  class Copies {
   public:
    /// Counts them.
    Copies(const SharedMemory& one, std::size_t count) noexcept : block_(one.block_), left_(count) {
      block_->handles.fetch_add(count, std::memory_order_relaxed);
    }
    Copies(const Copies&) = delete;
    Copies& operator=(const Copies&) = delete;
    ~Copies() {
      if (left_ > 0) drop(block_, left_);
    }
    /// One of them; at most `count` times.
    SharedMemory take() noexcept {
      --left_;
      return SharedMemory(block_);
    }

   private:
    Block* block_;
    std::size_t left_;
  };

  /// Gives handles up, those on the same memory that come one after the other at once.
  class Sink {
   public:
    Sink() = default;
    Sink(const Sink&) = delete;
    Sink& operator=(const Sink&) = delete;
    ~Sink() { flush(); }
    /// Leaves the handle empty.
    void take(SharedMemory& handle) noexcept {
      if (handle.block_ != block_) {
        flush();
        block_ = handle.block_;
        count_ = 0;
      }
      ++count_;
      handle.block_ = nullptr;
    }

   private:
    void flush() noexcept {
      if (block_) drop(block_, count_);
    }
    Block* block_ = nullptr;
    std::size_t count_ = 0;
  };
};

}  // namespace tessera::inline abi_0_1
#pragma GCC visibility pop
