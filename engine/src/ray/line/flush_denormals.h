#pragma once
// The floating-point mode of a thread that traces rays. One source for each kind of processor: flush_denormals_x86.cpp,
// and flush_denormals_none.cpp where the mode stays as it is.

namespace tessera { inline namespace abi_0_1 {

/// Sets flush-to-zero and denormals-are-zero for this thread, and masks floating-point exceptions, for speed and as
/// Embree wants them; the end of the scope restores the caller's state. Doubles are affected too, so only tracing
/// belongs inside.
class FlushDenormals {
 public:
  FlushDenormals();
  ~FlushDenormals();
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  [[maybe_unused]] unsigned saved_;
};

/// Within a FlushDenormals: lets denormal numbers count again, for foreign code.
class CountDenormals {
 public:
  CountDenormals();
  ~CountDenormals();
  CountDenormals(const CountDenormals&) = delete;
  CountDenormals& operator=(const CountDenormals&) = delete;

 private:
  [[maybe_unused]] unsigned saved_;
};

}}  // namespace tessera::abi_0_1
