#include "serve/http.h"

#include <algorithm>
#include <array>
#include <charconv>

namespace tessera::cli {
namespace {

constexpr std::string_view end_of_line = "\r\n", end_of_head = "\r\n\r\n";

bool is_letter_or_digit(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'); }

/// A character of a token: a method, or the name of a header (RFC 9110, 5.6.2).
bool is_of_token(char c) {
  return is_letter_or_digit(c) || std::string_view("!#$%&'*+-.^_`|~").find(c) != std::string_view::npos;
}

bool is_token(std::string_view text) { return !text.empty() && std::ranges::all_of(text, is_of_token); }

std::string in_small_letters(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

/// Removes the text before `mark`, and the mark; all that is left if there is none.
std::string_view take_until(std::string_view& text, std::string_view mark) {
  const std::size_t end = std::min(text.find(mark), text.size());
  const std::string_view taken = text.substr(0, end);
  text.remove_prefix(std::min(end + mark.size(), text.size()));
  return taken;
}

std::string_view without_blanks(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

/// Decodes %XX; false for other characters after %, and for a zero byte.
bool decode(std::string_view text, std::string& out) {
  for (std::size_t k = 0; k < text.size(); ++k) {
    if (text[k] != '%') {
      out += text[k];
      continue;
    }
    const std::string_view digits = text.substr(k + 1, 2);
    unsigned value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
    if (digits.size() < 2 || error != std::errc() || end != digits.data() + 2 || value == 0) return false;
    out += static_cast<char>(value);
    k += 2;
  }
  return true;
}

int parse_request_line(std::string_view line, HttpRequest& request) {
  request.method = take_until(line, " ");
  const std::string_view target = take_until(line, " ");
  const bool is_printable = std::ranges::all_of(target, [](char c) { return c > ' ' && c < 0x7f; });
  if (!is_token(request.method) || !target.starts_with('/') || !is_printable) return 400;
  if (line != "HTTP/1.1" && line != "HTTP/1.0") return line.starts_with("HTTP/") ? 505 : 400;
  return decode(target.substr(0, target.find_first_of("?#")), request.path) ? 200 : 400;
}

constexpr std::array<std::pair<int, const char*>, 9> reasons{{{200, "OK"},
                                                              {400, "Bad Request"},
                                                              {403, "Forbidden"},
                                                              {404, "Not Found"},
                                                              {405, "Method Not Allowed"},
                                                              {408, "Request Timeout"},
                                                              {431, "Request Header Fields Too Large"},
                                                              {500, "Internal Server Error"},
                                                              {505, "HTTP Version Not Supported"}}};

const char* reason_of(int status) {
  const auto known = std::ranges::find(reasons, status, &std::pair<int, const char*>::first);
  return known == reasons.end() ? "Error" : known->second;
}

}  // namespace

bool is_whole_head(std::string_view bytes) { return bytes.find(end_of_head) != std::string_view::npos; }

int parse_head(std::string_view bytes, HttpRequest& request) {
  request = {};
  std::string_view head = bytes.substr(0, bytes.find(end_of_head));
  if (const int status = parse_request_line(take_until(head, end_of_line), request); status != 200) return status;
  std::size_t hosts = 0;
  while (!head.empty()) {
    const std::string_view line = take_until(head, end_of_line);
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos || !is_token(line.substr(0, colon))) return 400;
    if (in_small_letters(line.substr(0, colon)) != "host") continue;
    request.host = in_small_letters(without_blanks(line.substr(colon + 1)));
    ++hosts;
  }
  return hosts == 1 ? 200 : 400;
}

std::string encoded_for_path(std::string_view name) {
  constexpr std::string_view digits = "0123456789ABCDEF";
  std::string out;
  for (const char c : name) {
    if (is_letter_or_digit(c) || std::string_view("-._~").find(c) != std::string_view::npos) {
      out += c;
      continue;
    }
    const auto byte = static_cast<unsigned char>(c);
    out += {'%', digits[byte / 16], digits[byte % 16]};
  }
  return out;
}

HttpResponse text_response(int status, const std::string& text) {
  HttpResponse response{.status = status, .type = "text/plain; charset=utf-8"};
  response.text = std::make_shared<const std::string>(text + "\n");
  return response;
}

std::string head_of(const HttpResponse& response, std::uint64_t bytes) {
  std::string head = "HTTP/1.1 " + std::to_string(response.status) + " " + reason_of(response.status);
  const auto add = [&head](const std::string& name, const std::string& value) { head += "\r\n" + name + ": " + value; };
  add("Content-Type", response.type);
  add("Content-Length", std::to_string(bytes));
  add("Connection", "close");
  add("Cache-Control", "no-store");
  add("X-Content-Type-Options", "nosniff");
  add("Referrer-Policy", "no-referrer");
  add("Cross-Origin-Opener-Policy", "same-origin");
  add("Cross-Origin-Embedder-Policy", "require-corp");
  add("Cross-Origin-Resource-Policy", "same-origin");
  for (const auto& [name, value] : response.headers) add(name, value);
  return head + "\r\n\r\n";
}

}  // namespace tessera::cli
