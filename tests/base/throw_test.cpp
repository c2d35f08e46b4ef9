// Errors as exceptions.

#include "tessera/throw.h"

#include <gtest/gtest.h>

#include <memory>

namespace tessera::test { namespace {

TEST(Throw, ValuesAreMovedOutAndErrorsKeepTheirStatus) {
  EXPECT_EQ(*value_or_throw(Result<std::unique_ptr<int>>(std::make_unique<int>(3))), 3);
  EXPECT_NO_THROW(throw_if_failed(Status()));
  try {
    value_or_throw(Result<int>(Status(StatusCode::stale, "the set was edited", 7)));
    FAIL() << "nothing was thrown";
  } catch (const StatusError& error) {
    EXPECT_STREQ(error.what(), "the set was edited");
    EXPECT_EQ(error.status().code(), StatusCode::stale);
    EXPECT_EQ(error.status().index(), 7);
  }
  EXPECT_THROW(throw_if_failed(Status(StatusCode::internal, "")), std::runtime_error);
}

}}  // namespace tessera::test
