#pragma once
// Expectations on errors.

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "tessera/status.h"

namespace tessera::test {

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// Expects that the call failed with this code and index, and that its message holds these words.
template <class T>
void expect_refused(const Result<T>& result, StatusCode code, std::ptrdiff_t index, const std::string& words) {
  ASSERT_FALSE(result.ok()) << words;
  EXPECT_EQ(result.status().code(), code) << result.status().message();
  EXPECT_EQ(result.status().index(), index) << result.status().message();
  EXPECT_NE(result.status().message().find(words), std::string::npos) << result.status().message();
}

}  // namespace tessera::test
