#pragma once
// Results that outlive their job.

#include <memory>
#include <utility>

namespace tessera::cli {

/// Keeps an object until drop_kept(), for which run_jobs() sees before the next job. Those of the last job are left to
/// the system, which takes back the memory of a process at once: the objects of a large model, one after the other,
/// take 2% of the time that its mesh takes on one thread.
void keep(std::shared_ptr<void> object);
/// Destroys what is kept.
void drop_kept();

/// Keeps a result, and returns it where it stays.
template <class T>
T& kept(T result) {
  auto own = std::make_shared<T>(std::move(result));
  T& place = *own;
  keep(std::move(own));
  return place;
}

}  // namespace tessera::cli
