#include "c/forks.h"

#include <pthread.h>

#include <atomic>
#include <mutex>

#include "c/handles.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

std::atomic<bool> was_forked = false;
std::once_flag watching_forks;

}  // namespace

bool is_forked() {
  std::call_once(watching_forks, [] {
    pthread_atfork(lock_handles, unlock_handles, [] {
      unlock_handles();
      was_forked = true;
    });
  });
  return was_forked;
}

}}  // namespace tessera::abi_0_1
