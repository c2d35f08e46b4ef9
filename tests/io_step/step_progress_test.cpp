// Progress and cancellation of reading a STEP file and of packing its surfaces, on any number of threads.

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "parallel/caller_arena.h"
#include "parallel/tbb_loop.h"
#include "support/errors.h"
#include "tessera/io.h"
#include "tessera/model.h"

namespace tessera::test { namespace {

const std::string block = TESSERA_SOURCE_DIR "/tools/models/bearing_block.step";

Status read_block(const Execution& execution) {
  ModelReadOptions options;
  options.cad.cancel = execution.cancel;
  options.cad.progress = execution.progress;
  return read_model(block, options).status();
}

Status pack_block(const Execution& execution) {
  const Result<Model> model = read_model(block);
  EXPECT_TRUE(model) << model.status().message();
  return model ? make_patch_set(*model, {.execution = execution}).status() : model.status();
}

/// Expects shares that rise from above 0 to 1, and an end once cancel is set at the `at`-th one.
void expect_progress(const std::function<Status(const Execution&)>& call, std::size_t least) {
  std::vector<double> shares;
  const Status whole = call({.progress = [&](double share) { shares.push_back(share); }});
  EXPECT_TRUE(whole.ok()) << whole.message();
  ASSERT_GE(shares.size(), least);
  double last = 0;
  for (const double share : shares) EXPECT_GT(share, std::exchange(last, share));
  EXPECT_EQ(last, 1);
  for (std::size_t at = 0; at + 1 < shares.size(); ++at) {
    std::atomic<bool> cancel = false;
    std::size_t calls = 0;
    const Status status = call({.cancel = &cancel, .progress = [&](double share) {
                                  if (calls++ == at && share < 1) cancel = true;
                                }});
    EXPECT_TRUE(!cancel || status.code() == StatusCode::cancelled) << at << ": " << status.message();
  }
}

TEST(StepProgress, ReadingRisesToOneAndSeesCancelAtEachShare) {
  for (const int threads : {1, 4}) in_own_arena(threads, [] { expect_progress(read_block, 20); });
}

TEST(StepProgress, PackingRisesToOneAndSeesCancelAtEachShare) {
  for (const int threads : {1, 4}) in_own_arena(threads, [] { expect_progress(pack_block, 2); });
}

}}  // namespace tessera::test
