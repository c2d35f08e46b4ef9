// Two pieces of one loop write one number without a lock. The thread sanitizer must report it: a test of the setup that
// the other tests rely on.

#include <cstdio>
#include <thread>

#include "parallel/parallel_for.h"
#include "robustness/workers.h"

int main() {
  int shared = 0;
  tessera::test::with_workers(4, [&] {
    tessera::test::Meeting meeting(2);
    const tessera::Status status = tessera::parallel_for(8, 1, {}, [&](std::size_t, std::size_t) {
      meeting.join();
      ++shared;
    });
    std::printf("%d: %s\n", shared, status.ok() ? "done" : status.message().c_str());
  });
  return 0;
}
