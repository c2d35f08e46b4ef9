// The digits of a double in fixed and in scientific notation, for std::to_chars() of libc++ 19: its own take 100 KB of
// tables, a tenth of the module, and printf(), which is in the module for other reasons, has the same digits.

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <system_error>

namespace std { inline namespace _LIBCPP_ABI_NAMESPACE {

namespace {

/// Prints `value`, which is not negative, with so many digits after the point.
to_chars_result print(const char* format, char* first, char* last, double value, uint32_t precision) {
  char text[2048];  // 309 digits, the point, and no more than 1074 digits that are not 0
  if (precision > 1600) return {last, errc::value_too_large};
  const int bytes = std::snprintf(text, sizeof text, format, static_cast<int>(precision), value);
  if (bytes < 0 || bytes > last - first) return {last, errc::value_too_large};
  return {std::copy(text, text + bytes, first), errc()};
}

}  // namespace

to_chars_result __d2fixed_buffered_n(char* first, char* last, double value, uint32_t precision) {
  return print("%.*f", first, last, value, precision);
}
to_chars_result __d2exp_buffered_n(char* first, char* last, double value, uint32_t precision) {
  return print("%.*e", first, last, value, precision);
}

/// Writes a number of so many decimal digits.
void __append_n_digits(uint32_t count, uint32_t number, char* to) {
  for (uint32_t k = count; k > 0; --k, number /= 10) to[k - 1] = static_cast<char>('0' + number % 10);
}
/// Writes nine digits, with leading zeros.
void __append_nine_digits(uint32_t number, char* to) { __append_n_digits(9, number, to); }

}}  // namespace std::_LIBCPP_ABI_NAMESPACE
