#pragma once
// Checks of arguments for every evaluation over a grid of a surface's own parameters.

#include <cmath>
#include <span>
#include <string>

#include "base/text.h"
#include "eval/grid_checks.h"
#include "tessera/status.h"
#include "tessera/strided_view.h"

namespace tessera { inline namespace abi_0_1 {

/// Checks that there is at least one parameter and that each lies within [from, to]. Errors: invalid_argument,
/// non_finite (index = the parameter).
inline Status check_parameters(std::span<const double> parameters, const char* name, double from, double to) {
  if (parameters.empty()) return {StatusCode::invalid_argument, std::string("there are no parameters ") + name};
  for (std::size_t k = 0; k < parameters.size(); ++k)
    if (!(parameters[k] >= from && parameters[k] <= to))
      return {std::isfinite(parameters[k]) ? StatusCode::invalid_argument : StatusCode::non_finite,
              std::string("parameter ") + name + "[" + std::to_string(k) + "] = " + text(parameters[k]) +
                  " is not within [" + text(from) + ", " + text(to) + "]",
              static_cast<std::ptrdiff_t>(k)};
  return {};
}

/// Checks that the view has room for u.size() * v.size() records, is aligned, and shares no memory with the parameters.
/// Errors: invalid_argument, buffer_too_small.
template <class T>
Status check_view(const View3<T>& out, std::span<const double> u, std::span<const double> v) {
  if (out.empty() || out.component[1] == nullptr || out.component[2] == nullptr || out.stride < 1)
    return {StatusCode::invalid_argument, "the view needs three components and a stride of at least 1"};
  if (u.size() > out.size / v.size())
    return {StatusCode::buffer_too_small, "the output needs " + std::to_string(u.size()) + " * " +
                                              std::to_string(v.size()) + " records, not " + std::to_string(out.size)};
  ViewChecks checks(u.size() * v.size());
  checks.add("position", out);
  checks.add("u", View1<const double>{.component = {u.data()}, .stride = 1, .size = u.size()}, u.size());
  checks.add("v", View1<const double>{.component = {v.data()}, .stride = 1, .size = v.size()}, v.size());
  return checks.status();
}

}}  // namespace tessera::abi_0_1
