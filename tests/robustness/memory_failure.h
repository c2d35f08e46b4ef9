#pragma once
// Calls whose memory runs out: every allocation fails once, one run after the other.

#include <gtest/gtest.h>

#include <cstdio>
#include <string>
#include <utility>

#include "support/allocations.h"
#include "tessera/status.h"

namespace tessera::test {

inline Status status_of(Status status) { return status; }
template <class T>
Status status_of(Result<T> result) {
  return result.ok() ? Status() : result.status();
}

/// call() returns a Status or a Result with the code `wanted`, and allocates nothing itself.
template <class Call>
void survives(const std::string& name, Call call, StatusCode wanted = StatusCode::ok) {
  Status status = status_of(call());  // what is made once for all calls
  ASSERT_EQ(status.code(), wanted) << name << ": " << status.message();
  (void)call();
  std::size_t n = 0;
  for (bool failed = true; failed; ++n) {
    ASSERT_LT(n, 100000u) << name;
    // Runs twice: the first run may leave an object in another state, or made once; memory that the second run adds is
    // a leak.
    std::size_t before = 0, after = 0;
    for (int time = 0; time < 2; ++time) {
      status = {};  // its message is memory, too
      before = restart_peak();
      fail_allocation(n);
      {
        auto result = call();
        failed = stop_failing();
        Status now = status_of(std::move(result));  // copies a message
        const StatusCode code = now.code();
        // A buffer that std::stable_sort does without may be the one.
        if (code != wanted && (code != StatusCode::out_of_memory || !failed))
          status = {StatusCode::internal, now.ok() ? "no error" : now.message()};
      }
      after = restart_peak();
      if (!failed || !status.ok()) break;
    }
    ASSERT_TRUE(status.ok()) << name << ", allocation " << n << ": " << status.message();
    ASSERT_LE(after, before) << name << ", allocation " << n << " fails: " << after - before << " bytes are lost";
  }
  std::printf("%-40s %6zu allocations\n", name.c_str(), n - 1);
}

}  // namespace tessera::test
