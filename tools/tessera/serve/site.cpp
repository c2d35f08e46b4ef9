#include "serve/site.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <system_error>

namespace tessera::cli {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view model_folder = "/model/";
constexpr const char* first_page = "index.html";
constexpr const char* unknown_type = "application/octet-stream";
constexpr std::uint64_t max_page_bytes = 1 << 20;

constexpr std::array<std::pair<std::string_view, const char*>, 13> types{{{".html", "text/html; charset=utf-8"},
                                                                          {".js", "text/javascript; charset=utf-8"},
                                                                          {".mjs", "text/javascript; charset=utf-8"},
                                                                          {".css", "text/css; charset=utf-8"},
                                                                          {".json", "application/json"},
                                                                          {".map", "application/json"},
                                                                          {".webmanifest", "application/manifest+json"},
                                                                          {".wasm", "application/wasm"},
                                                                          {".svg", "image/svg+xml"},
                                                                          {".png", "image/png"},
                                                                          {".ico", "image/x-icon"},
                                                                          {".woff2", "font/woff2"},
                                                                          {".txt", "text/plain; charset=utf-8"}}};

const char* type_of(const fs::path& name) {
  const auto known =
      std::ranges::find(types, name.extension().string(), &std::pair<std::string_view, const char*>::first);
  return known == types.end() ? unknown_type : known->second;
}

/// Lets a page have its own scripts, workers and WebAssembly, and nothing of the network, as tools/web/serve.mjs does.
std::string content_policy(const std::string& nonce) {
  return "default-src 'none'; script-src 'self' 'wasm-unsafe-eval' 'nonce-" + nonce +
         "'; worker-src 'self'; connect-src 'self'; style-src 'self'; img-src 'self' blob:; base-uri 'none'; "
         "form-action 'none'; frame-ancestors 'none'";
}

/// 128 random bits in hexadecimal digits.
std::string random_digits() {
  std::random_device device;
  std::string text;
  for (int k = 0; k < 4; ++k) {
    std::array<char, 9> digits{};
    std::snprintf(digits.data(), digits.size(), "%08x", device());
    text += digits.data();
  }
  return text;
}

/// Marks the scripts of a page by a nonce: an import map stands within the page, and no file of its own may be one.
std::string with_nonce(std::string page, const std::string& nonce) {
  constexpr std::string_view tag = "<script";
  const std::string attribute = " nonce=\"" + nonce + "\"";
  for (std::size_t at = 0; (at = page.find(tag, at)) != std::string::npos; at += tag.size() + attribute.size())
    page.insert(at + tag.size(), attribute);
  return page;
}

/// The whole content of a response's file, which is small.
std::string text_of(const HttpResponse& response) {
  std::string text(std::min<std::uint64_t>(response.file_bytes, max_page_bytes), '\0');
  std::size_t size = 0;
  for (ssize_t got = 1; size < text.size() && got > 0; size += static_cast<std::size_t>(std::max<ssize_t>(got, 0)))
    got = ::read(response.file.number(), text.data() + size, text.size() - size);
  text.resize(size);
  return text;
}

/// The response with an open file as its content; null is 404.
HttpResponse file_response(Descriptor file, const char* type) {
  struct stat facts {};
  if (!file.is_open() || ::fstat(file.number(), &facts) != 0 || !S_ISREG(facts.st_mode))
    return text_response(404, "There is no such file.");
  HttpResponse response{.status = 200, .type = type};
  response.file = std::move(file);
  response.file_bytes = static_cast<std::uint64_t>(facts.st_size);
  return response;
}

/// Opens a file below a folder. A link, a name that begins with a dot, or an empty one: nothing is opened.
Descriptor open_below(const Descriptor& folder, std::string_view path) {
  Descriptor inner;
  while (true) {
    const std::size_t end = std::min(path.find('/'), path.size());
    const std::string name(path.substr(0, end));
    if (name.empty() || name[0] == '.') return {};
    const bool is_last = end == path.size();
    const int at = inner.is_open() ? inner.number() : folder.number();
    // O_NONBLOCK: a pipe is no reason to wait.
    const int flags = O_RDONLY | O_CLOEXEC | O_NOFOLLOW | (is_last ? O_NONBLOCK : O_DIRECTORY);
    Descriptor next(::openat(at, name.c_str(), flags));
    if (is_last || !next.is_open()) return next;
    inner = std::move(next);
    path.remove_prefix(end + 1);
  }
}

bool has_page(const fs::path& folder) {
  std::error_code error;
  return fs::is_regular_file(folder / first_page, error);
}

Status no_page(const std::string& looked_for) {
  return Status(StatusCode::io_error,
                "the page of view is not there: " + looked_for +
                    "; make it in Tessera's sources by cmake --preset wasm && cmake --build build/wasm --target "
                    "tessera_web, and name its folder, build/wasm/web, by --web FOLDER or TESSERA_WEB if this program "
                    "does not look there");
}

}  // namespace

Site::Site(Descriptor folder, ServedModel model, std::string nonce)
    : folder_(std::move(folder)), model_(std::move(model)), nonce_(std::move(nonce)) {}

Result<Site> Site::make(const fs::path& folder, ServedModel model) {
  Descriptor opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!opened.is_open())
    return Status(StatusCode::io_error,
                  folder.string() + ": cannot be opened: " + std::system_category().message(errno));
  if (!open_below(opened, first_page).is_open()) return no_page(folder.string() + " has no file index.html");
  return Site(std::move(opened), std::move(model), random_digits());
}

std::string Site::address() const {
  // The query is decoded once by the page, and the path that it holds once by this server.
  std::string twice;
  for (const char c : encoded_for_path(model_.name)) twice += c == '%' ? std::string("%25") : std::string(1, c);
  return "/?model=" + std::string(model_folder) + twice;
}

HttpResponse Site::model_response() const {
  if (!model_.bytes)
    return file_response(Descriptor(::open(model_.file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)), unknown_type);
  HttpResponse response{.status = 200, .type = unknown_type};
  response.text = model_.bytes;
  return response;
}

HttpResponse Site::page_response(const std::string& name) const {
  HttpResponse response = file_response(open_below(folder_, name), type_of(name));
  if (response.status == 200 && name.ends_with(".html")) {
    response.text = std::make_shared<const std::string>(with_nonce(text_of(response), nonce_));
    response.file = {};
  }
  return response;
}

HttpResponse Site::respond(const HttpRequest& request) const {
  const std::string_view path = request.path;
  HttpResponse response;
  if (path.starts_with(model_folder)) {
    const bool is_known = path.substr(model_folder.size()) == model_.name;
    response = is_known ? model_response() : text_response(404, "There is no such model.");
  } else {
    response = page_response(path == "/" ? first_page : std::string(path.substr(1)));
  }
  response.headers.emplace_back("Content-Security-Policy", content_policy(nonce_));
  return response;
}

std::vector<fs::path> usual_web_folders() {
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  if (error) return {};
  const fs::path own = self.parent_path();
  // The program of a build lies in build/NAME/tools.
  return {(own / "../share/tessera/web").lexically_normal(), (own / "../../wasm/web").lexically_normal()};
}

Result<fs::path> find_web_folder(const std::string& named) {
  const char* const variable = std::getenv("TESSERA_WEB");
  const std::string wanted = !named.empty() ? named : variable ? variable : "";
  if (!wanted.empty()) {
    if (has_page(wanted)) return fs::path(wanted);
    return no_page(wanted + " has no file index.html");
  }
  std::string places;
  for (const fs::path& place : usual_web_folders()) {
    if (has_page(place)) return place;
    places += (places.empty() ? "neither " : " nor ") + place.string();
  }
  return no_page(places + " has a file index.html");
}

}  // namespace tessera::cli
