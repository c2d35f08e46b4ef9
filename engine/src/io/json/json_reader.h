#pragma once
// The elements of which JSON models consist. Readers throw JsonFailure, with the place, for anything malformed.

#include <algorithm>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/json/json_document.h"
#include "tessera/curve.h"
#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

/// An object with a known set of keys. An unknown key is an error, so that no typing error is silent.
class Fields {
 public:
  Fields(const JsonValue& value, std::initializer_list<std::string_view> keys,
         std::initializer_list<std::string_view> more = {});

  const JsonValue& value() const { return value_; }
  std::optional<JsonValue> find(std::string_view key) const { return value_.find(key); }
  JsonValue at(std::string_view key) const;
  /// Applies `read` to the member, or returns `otherwise` if there is none.
  template <class T, class Read>
  T get(std::string_view key, T otherwise, Read&& read) const {
    const std::optional<JsonValue> member = find(key);
    return member ? read(*member) : otherwise;
  }

 private:
  JsonValue value_;
};

/// The value of a result. On failure throws, with the place of the JSON that it was made from.
template <class T>
T made(const JsonValue& from, Result<T> result) {
  if (!result) from.fail(result.status().message(), result.status().code());
  return *std::move(result);
}

/// The elements of an array, at least `least` of them. `what` says what is expected: "an array of points".
JsonValue array(const JsonValue& value, std::string_view what, std::size_t least = 1);
/// An array of exactly `count` elements.
JsonValue array_of(const JsonValue& value, std::string_view what, std::size_t count);

/// Reads a number, or an expression of constants: "sqrt(2)/2".
double read_number(const JsonValue& value);
int read_integer(const JsonValue& value, int least, int largest);
const std::string& read_text(const JsonValue& value);
/// Reads a string; returns its index in `words`.
std::size_t read_word(const JsonValue& value, std::initializer_list<std::string_view> words);
Vec3 read_vector(const JsonValue& value);
std::vector<double> read_numbers(const JsonValue& value);
Interval read_interval(const JsonValue& value);
/// Reads [[u0, u1], [v0, v1]].
Domain read_domain(const JsonValue& value);

/// Rows of equal length: [i][j], i along u.
template <class T>
struct Net {
  std::size_t rows = 0, columns = 0;
  std::vector<T> elements;
};
/// The degree of a direction with `count` elements; for too many it is beyond max_degree.
inline int degree_of(std::size_t count) { return static_cast<int>(std::min<std::size_t>(count, max_degree + 2)) - 1; }
/// Reads a net; `what` names its elements: "points".
template <class T, class Read>
Net<T> read_net(const JsonValue& value, std::string_view what, Read&& read) {
  const std::string name(what);
  Net<T> net;
  for (const JsonValue row : array(value, "rows of " + name)) {
    const std::size_t count = array(row, "a row of " + name).size();
    if (net.rows == 0) {
      net.columns = count;
      net.elements.reserve(std::min(value.size() * count, value.span()));
    }
    if (count != net.columns)
      row.fail("row " + std::to_string(net.rows) + " has " + std::to_string(count) + " " + name + ", row 0 has " +
               std::to_string(net.columns));
    for (const JsonValue element : row) net.elements.push_back(read(element));
    ++net.rows;
  }
  return net;
}
inline Net<Vec3> read_vector_net(const JsonValue& value, std::string_view what = "points") {
  return read_net<Vec3>(value, what, read_vector);
}
inline Net<double> read_number_net(const JsonValue& value, std::string_view what) {
  return read_net<double>(value, what, read_number);
}
/// Fails unless the net has this shape; `reason` explains it: "as there are points".
template <class T>
void expect_shape(const JsonValue& value, const Net<T>& net, std::size_t rows, std::size_t columns,
                  std::string_view reason) {
  if (net.rows == rows && net.columns == columns) return;
  const auto shape = [](std::size_t m, std::size_t n) { return std::to_string(m) + " x " + std::to_string(n); };
  value.fail("expected " + shape(rows, columns) + ", " + std::string(reason) + ", found " +
             shape(net.rows, net.columns));
}

}}  // namespace tessera::abi_0_1
