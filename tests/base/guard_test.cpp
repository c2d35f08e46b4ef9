// Exceptions as a Status.

#include "tessera/guard.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <vector>

namespace tessera::test { namespace {

TEST(Guard, ExceptionsBecomeStatuses) {
  const auto code_of = [](auto&& body) { return guarded([&]() -> Status { return body(), Status(); }).code(); };
  EXPECT_EQ(code_of([] {}), StatusCode::ok);
  EXPECT_EQ(code_of([] { throw std::bad_alloc(); }), StatusCode::out_of_memory);
  std::vector<double> list;
  EXPECT_EQ(code_of([&] { list.resize(std::numeric_limits<std::size_t>::max()); }), StatusCode::out_of_memory);
  const Status other = guarded([]() -> Status { throw std::runtime_error("why"); });
  EXPECT_EQ(other.code(), StatusCode::internal);
  EXPECT_EQ(other.message(), "why");
}

}}  // namespace tessera::test
