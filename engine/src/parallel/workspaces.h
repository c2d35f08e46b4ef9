#pragma once
// Workspaces that tasks take turns to use.

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace tessera { inline namespace abi_0_1 {

/// Keeps the workspaces that tasks have used for those that come later, so that there are only as many as tasks at
/// once.
template <class T>
class Workspaces {
 public:
  /// A workspace until the end of its scope.
  class Lease {
   public:
    Lease(Workspaces& all, std::unique_ptr<T> own) : all_(all), own_(std::move(own)) {}
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
  /// `arguments`: of the constructor, if there is none to take.
  template <class... Arguments>
  Lease take(const Arguments&... arguments) {
    std::unique_ptr<T> own = last();
    return Lease(*this, own ? std::move(own) : std::make_unique<T>(arguments...));
  }

 private:
  /// The last one that was given back; null, and room for one more, if there is none.
  std::unique_ptr<T> last() {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) return free_.reserve(++count_), nullptr;
    std::unique_ptr<T> own = std::move(free_.back());
    free_.pop_back();
    return own;
  }

  std::mutex mutex_;
  std::size_t count_ = 0;  ///< so that giving one back needs no memory
  std::vector<std::unique_ptr<T>> free_;
};

}}  // namespace tessera::abi_0_1
