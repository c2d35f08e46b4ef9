#pragma once
// A locale with decimal commas and points between thousands.

#include <clocale>
#include <locale>
#include <stdexcept>
#include <string>

namespace tessera::test {

/// During its lifetime, the process has a locale of C and of C++ that writes 1.234,5 - if the system has one.
class CommaLocale {
 public:
  CommaLocale() : c_(std::setlocale(LC_ALL, nullptr)) {
    for (const char* const name : {"de_DE.UTF-8", "fr_FR.UTF-8"}) {
      if (!std::setlocale(LC_ALL, name)) continue;
      std::locale::global(std::locale(name));
      done_ = true;
      return;
    }
  }
  CommaLocale(const CommaLocale&) = delete;
  CommaLocale& operator=(const CommaLocale&) = delete;
  ~CommaLocale() {
    std::locale::global(cpp_);
    std::setlocale(LC_ALL, c_.c_str());
  }
  bool done() const { return done_; }

 private:
  std::string c_;
  std::locale cpp_;  // the global one as it was
  bool done_ = false;
};

}  // namespace tessera::test
