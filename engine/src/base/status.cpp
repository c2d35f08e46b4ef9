#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

Status::Status(StatusCode code, std::string message, std::ptrdiff_t index)
    : code_(code), index_(index), message_(std::move(message)) {}

std::string_view name(StatusCode code) {
  switch (code) {
    case StatusCode::ok:
      return "ok";
    case StatusCode::invalid_argument:
      return "invalid_argument";
    case StatusCode::non_finite:
      return "non_finite";
    case StatusCode::invalid_weight:
      return "invalid_weight";
    case StatusCode::unsupported_degree:
      return "unsupported_degree";
    case StatusCode::count_mismatch:
      return "count_mismatch";
    case StatusCode::buffer_too_small:
      return "buffer_too_small";
    case StatusCode::unsupported:
      return "unsupported";
    case StatusCode::isa_unavailable:
      return "isa_unavailable";
    case StatusCode::stale:
      return "stale";
    case StatusCode::parse_error:
      return "parse_error";
    case StatusCode::io_error:
      return "io_error";
    case StatusCode::out_of_memory:
      return "out_of_memory";
    case StatusCode::cancelled:
      return "cancelled";
    case StatusCode::internal:
      return "internal";
  }
  return "unknown";
}

}}  // namespace tessera::abi_0_1
