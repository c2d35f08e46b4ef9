#pragma once
// Records of the caller's memory: views of pairs, views that hold for all records, outputs that are long enough.

#include <string>

#include "c/calls.h"

namespace tessera { inline namespace abi_0_1 {

/// Reads a view of which one record holds for all `records`: its stride in C++ is 0.
template <class T, int N>
CStatus view_for_all(const char* name, const tsr_in& in, std::size_t records, VectorView<const T, N>& view) {
  if (CStatus status = view_of(name, in, view); status.code) return status;
  if (in.data && in.count == 1 && records != 1) view.stride = 0;
  return {};
}

/// Returns one component of a view of two, of numbers of `size` bytes.
inline tsr_out component_of(const tsr_out& pair, std::int64_t size, int c) {
  tsr_out one = pair;
  if (one.record == 0) one.record = 2 * size;
  const std::int64_t step = pair.component == 0 ? size : pair.component;
  if (pair.data) one.data = static_cast<char*>(pair.data) + c * step;
  one.component = 0;
  return one;
}

/// Reads a view that `records` records are written to; empty if it is not wanted.
template <class T, int N>
CStatus output_of(const char* name, const tsr_out& out, std::size_t records, VectorView<T, N>& view) {
  if (CStatus status = view_of(name, out, view); status.code || view.empty()) return status;
  if (view.stride < 1) return bad(std::string(name) + ": the stride of records must be above 0");
  if (view.size >= records) return {};
  return {TSR_BUFFER_TOO_SMALL,
          std::string(name) + " holds " + std::to_string(view.size) + " records, there are " + std::to_string(records)};
}

/// Writes `value(k)` to each of `records` records of a view, unless it is not wanted.
template <class T, class Value>
void write_records(const View1<T>& view, std::size_t records, Value&& value) {
  if (view.empty()) return;
  for (std::size_t k = 0; k < records; ++k) view.at(k, 0) = static_cast<T>(value(k));
}

}}  // namespace tessera::abi_0_1
