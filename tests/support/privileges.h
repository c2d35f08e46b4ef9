#pragma once
// Tests of permissions, which do not bind the superuser.

#include <unistd.h>

#include <cstdlib>

namespace tessera::test {

/// During its lifetime, the superuser is an ordinary user, whom permissions bind.
class WithoutPrivileges {
 public:
  WithoutPrivileges() : root_(::geteuid() == 0) { done_ = !root_ || ::seteuid(65534) == 0; }
  WithoutPrivileges(const WithoutPrivileges&) = delete;
  WithoutPrivileges& operator=(const WithoutPrivileges&) = delete;
  ~WithoutPrivileges() {
    if (root_ && ::seteuid(0) != 0) std::abort();
  }
  bool done() const { return done_; }

 private:
  bool root_, done_ = false;
};

}  // namespace tessera::test
