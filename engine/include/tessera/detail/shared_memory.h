#pragma once
// Memory that many objects share.

#include <atomic>
#include <cstddef>
#include <new>
#include <utility>

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// A handle on memory that is freed with its last handle. Unlike std::shared_ptr, one change of the count makes or
/// releases many handles: a surface has tens of thousands of pieces, and an atomic operation for each would cost as
/// much as computing them. Threads: as for std::shared_ptr.
class SharedMemory {
 public:
  /// An empty handle.
  SharedMemory() = default;
  /// The first handle on `bytes` of uninitialised memory. Throws std::bad_alloc.
  explicit SharedMemory(std::size_t bytes) : block_(::new (::operator new(sizeof(Block) + bytes)) Block) {}
  /// Adds a handle on the memory.
  SharedMemory(const SharedMemory& other) noexcept : block_(other.block_) {
    if (block_) block_->handles.fetch_add(1, std::memory_order_relaxed);
  }
  /// Takes over the handle; `other` becomes empty.
  SharedMemory(SharedMemory&& other) noexcept : block_(std::exchange(other.block_, nullptr)) {}
  /// Replaces this handle, and releases the previous one.
  SharedMemory& operator=(SharedMemory other) noexcept {
    std::swap(block_, other.block_);
    return *this;
  }
  ~SharedMemory() {
    if (block_) drop(block_, 1);
  }

  /// Whether this is the only handle on the memory. The handle must not be empty.
  bool sole() const noexcept { return block_->handles.load(std::memory_order_acquire) == 1; }
  /// Returns the first byte, aligned as by operator new. The handle must not be empty.
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
  /// `count` more handles on the memory of `one`, added to the count at once.
  class Copies {
   public:
    /// Adds `count` to the count. `one` must not be empty.
    Copies(const SharedMemory& one, std::size_t count) noexcept : block_(one.block_), left_(count) {
      block_->handles.fetch_add(count, std::memory_order_relaxed);
    }
    Copies(const Copies&) = delete;
    Copies& operator=(const Copies&) = delete;
    ~Copies() {
      if (left_ > 0) drop(block_, left_);
    }
    /// Returns one of the handles; at most `count` calls.
    SharedMemory take() noexcept {
      --left_;
      return SharedMemory(block_);
    }

   private:
    Block* block_;
    std::size_t left_;
  };

  /// Releases handles. Consecutive handles on the same memory are released by one change of the count.
  class Sink {
   public:
    Sink() = default;
    Sink(const Sink&) = delete;
    Sink& operator=(const Sink&) = delete;
    ~Sink() { flush(); }
    /// Takes the handle to release it later, and leaves it empty.
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

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
