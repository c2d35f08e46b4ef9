// Forked processes: an answer or an error, never a hang.

#include <sys/wait.h>
#include <unistd.h>

#include "c/c_objects.h"

namespace tessera::test { namespace {

/// Runs a call in a child process. Returns its status; -1 if the child did not end by itself.
template <class Call>
int in_child(Call call) {
  const pid_t child = ::fork();
  if (child == 0) {
    ::alarm(20);
    ::_exit(call());
  }
  int state = 0;
  ::waitpid(child, &state, 0);
  return WIFEXITED(state) ? WEXITSTATUS(state) : -1;
}

TEST(CFork, ChildrenOfAProcessThatComputedGetErrors) {
  const Handle<tsr_set> set = set_of(wavy_field(20, 20));
  const Handle<tsr_plan> plan = plan_of(set.get(), 1e-3);
  EXPECT_EQ(in_child([&] {
              tsr_scene* scene = nullptr;
              return tsr_scene_new(&scene, set.get(), nullptr, nullptr);
            }),
            TSR_UNSUPPORTED);
  EXPECT_EQ(in_child([&] {
              tsr_plan_info info = sized<tsr_plan_info>();
              return tsr_plan_describe(plan.get(), &info) + tsr_release(tsr_retain(set.get()) ? nullptr : set.get());
            }),
            TSR_OK);
}

}}  // namespace tessera::test
