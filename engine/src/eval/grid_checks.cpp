#include "eval/grid_checks.h"

#include <limits>
#include <numeric>
#include <string>

#include "base/text.h"

namespace tessera { inline namespace abi_0_1 {

void ViewChecks::add(const Array& array, std::size_t size, std::size_t alignment) {
  if (!error_.ok()) return;
  const auto refuse = [&](const std::string& why, StatusCode code = StatusCode::invalid_argument) {
    error_ = Status(code, std::string(array.name) + why);
  };
  const auto most = static_cast<std::size_t>(std::numeric_limits<std::ptrdiff_t>::max());
  if (size < array.records)
    return refuse(" needs " + std::to_string(array.records) + " records, not " + std::to_string(size),
                  StatusCode::buffer_too_small);
  if (array.begin == 0 || array.stride < 1)
    return refuse(array.begin == 0 ? ": a component of the view has no memory"
                                   : ": the stride is " + std::to_string(array.stride) + ", it must be at least 1");
  if (array.begin % alignment != 0)
    return refuse(": the view's memory must be aligned to " + counted(alignment, "byte"));
  if (array.records > 0 && static_cast<std::size_t>(array.stride) > most / array.element / array.records)
    return refuse(": a stride of " + std::to_string(array.stride) + " over " + counted(array.records, "record") +
                  " reaches beyond the address space");
  arrays_.at(count_++) = array;
}

/// Whether a number of one array shares memory with a number of the other. Exact for arrays of equal stride. If the
/// strides differ and the ranges overlap, the answer is that of arrays without end: two numbers then meet if their
/// addresses agree modulo the greatest common divisor of the strides.
bool ViewChecks::collide(const Array& a, const Array& b) const {
  const auto step = [&](const Array& array) {
    return array.records == 1 ? 0 : static_cast<std::size_t>(array.stride) * array.element;
  };
  const auto end = [&](const Array& array) { return array.begin + (array.records - 1) * step(array) + array.element; };
  if (a.records == 0 || b.records == 0 || a.begin >= end(b) || b.begin >= end(a)) return false;
  const std::size_t period = std::gcd(step(a), step(b));
  if (period == 0) return true;
  const bool ahead = b.begin >= a.begin;
  const std::size_t distance = (ahead ? b.begin - a.begin : a.begin - b.begin) % period;
  return distance < (ahead ? a : b).element || period - distance < (ahead ? b : a).element;
}

Status ViewChecks::status() const {
  if (!error_.ok()) return error_;
  for (std::size_t i = 0; i < count_; ++i)
    for (std::size_t j = i + 1; j < count_; ++j)
      if ((arrays_[i].written || arrays_[j].written) && collide(arrays_[i], arrays_[j]))
        return Status(StatusCode::invalid_argument,
                      std::string(arrays_[i].name) + " and " + arrays_[j].name + " share memory");
  return {};
}

}}  // namespace tessera::abi_0_1
