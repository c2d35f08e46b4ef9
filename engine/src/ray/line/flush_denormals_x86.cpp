// The mode of SSE and AVX.

#include <xmmintrin.h>

#include "ray/line/flush_denormals.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr unsigned flush_and_denormals_are_zero = 0x8040;
constexpr unsigned all_exceptions_masked = 0x1f80;

}  // namespace

FlushDenormals::FlushDenormals() : saved_(_mm_getcsr()) {
  _mm_setcsr(saved_ | flush_and_denormals_are_zero | all_exceptions_masked);
}
FlushDenormals::~FlushDenormals() { _mm_setcsr(saved_); }

CountDenormals::CountDenormals() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ & ~flush_and_denormals_are_zero); }
CountDenormals::~CountDenormals() { _mm_setcsr(saved_); }

}}  // namespace tessera::abi_0_1
