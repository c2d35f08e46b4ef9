#pragma once
// Requests and responses of HTTP/1.1, as far as a server of files needs them (RFC 9110, RFC 9112).

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/file/descriptor.h"

namespace tessera::cli {

/// The head of a request. Requests without a body are read; what follows the head is not.
struct HttpRequest {
  std::string method;  ///< "GET"
  std::string path;    ///< decoded, without the query; begins with a slash
  std::string host;    ///< "127.0.0.1:8080", in small letters
};

struct HttpResponse {
  int status = 200;
  std::string type;                                            ///< of the content: "text/html; charset=utf-8"
  std::vector<std::pair<std::string, std::string>> headers{};  ///< beside those that every response has
  std::shared_ptr<const std::string> text{};                   ///< the content, unless it is a file
  Descriptor file{};                                           ///< an open file that is the content
  std::uint64_t file_bytes = 0;                                ///< its size
};

/// Limit of a request's head, in bytes.
inline constexpr std::size_t max_head_bytes = 16384;

/// Whether the bytes that have come hold the whole head of a request.
bool is_whole_head(std::string_view bytes);

/// Parses the head of a request into `request`. Returns 200, or the status of the response for a head that is wrong:
/// 400 (bad syntax, no Host or several, a path that is not decodable), 505 (another version).
int parse_head(std::string_view bytes, HttpRequest& request);

/// A text without slash as a part of a path: other characters than letters, digits and "-._~" become %XX.
std::string encoded_for_path(std::string_view name);

/// A response of one line of text, for errors.
HttpResponse text_response(int status, const std::string& text);

/// The head of a response, whose content has `bytes` bytes. Every response has these headers: the connection ends,
/// nothing is kept, types are not guessed, and pages of other origins have no access.
std::string head_of(const HttpResponse& response, std::uint64_t bytes);

}  // namespace tessera::cli
