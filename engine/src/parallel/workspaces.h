#pragma once
// Workspaces that tasks take turns to use.

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace tessera::inline abi_0_1 {

/// Keeps the workspaces that tasks have used for those that come later, so that there are only as many as tasks at once.
template <class T>
class Workspaces {
 public:
  /// A workspace until the end of its scope.
  class Lease {
   public:
    explicit Lease(Workspaces& all) : all_(all), own_(all.next()) {}
    ~Lease() {
      const std::lock_guard lock(all_.mutex_);
      all_.free_.push_back(std::move(own_));
    }
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;
    T& operator*() const { return *own_; }

   private:
    Workspaces& all_;
    std::unique_ptr<T> own_;
  };
  Lease take() { return Lease(*this); }

 private:
  std::unique_ptr<T> next() {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) {
      free_.reserve(++count_);
      return std::make_unique<T>();
    }
    std::unique_ptr<T> last = std::move(free_.back());
    free_.pop_back();
    return last;
  }

  std::mutex mutex_;
  std::size_t count_ = 0;  ///< so that giving one back needs no memory
  std::vector<std::unique_ptr<T>> free_;
};

}  // namespace tessera::inline abi_0_1
