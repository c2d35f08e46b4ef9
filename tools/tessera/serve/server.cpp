#include "serve/server.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <exception>
#include <system_error>
#include <thread>
#include <vector>

namespace tessera::cli {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

// A browser opens six connections, and a few in advance, which occupy a worker until they are used or time out.
constexpr int workers = 16;
constexpr auto slice = 50ms;           // after which a worker looks at the flag
constexpr auto head_limit = 5s;        // for the whole head of a request
constexpr auto send_limit = 30s;       // without a byte taken
constexpr auto closing_limit = 500ms;  // for the other side to close

/// Waits until a descriptor is ready for `events`; false at the deadline, or if `stop` is set.
bool wait_for(int descriptor, short events, Clock::time_point deadline, const std::atomic<bool>& stop) {
  while (!stop && Clock::now() < deadline) {
    pollfd one{.fd = descriptor, .events = events, .revents = 0};
    if (::poll(&one, 1, static_cast<int>(slice.count())) > 0) return true;
  }
  return false;
}

/// Sends all bytes; false if the other side has gone, or takes none for too long.
bool send_all(int connection, std::string_view bytes, const std::atomic<bool>& stop) {
  while (!bytes.empty()) {
    if (!wait_for(connection, POLLOUT, Clock::now() + send_limit, stop)) return false;
    const ssize_t sent = ::send(connection, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent > 0)
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    else if (errno != EAGAIN && errno != EINTR)
      return false;
  }
  return true;
}

/// Sends `bytes` bytes of a file. If it has become shorter, the connection ends early, which browsers report.
void send_file(int connection, const HttpResponse& response, const std::atomic<bool>& stop) {
  std::vector<char> buffer(std::size_t{1} << 16);
  for (std::uint64_t left = response.file_bytes; left > 0;) {
    const ssize_t got = ::read(response.file.number(), buffer.data(), std::min<std::uint64_t>(buffer.size(), left));
    if (got <= 0 || !send_all(connection, {buffer.data(), static_cast<std::size_t>(got)}, stop)) return;
    left -= static_cast<std::uint64_t>(got);
  }
}

/// Reads the head of a request. Returns 200, or the status of the response if it does not come, or is too long; 0 if
/// nobody asks.
int read_head(int connection, std::string& head, const std::atomic<bool>& stop) {
  const Clock::time_point deadline = Clock::now() + head_limit;
  std::array<char, 4096> buffer{};
  while (!is_whole_head(head)) {
    if (head.size() > max_head_bytes) return 431;
    if (!wait_for(connection, POLLIN, deadline, stop)) return head.empty() ? 0 : 408;
    const ssize_t got = ::recv(connection, buffer.data(), buffer.size(), 0);
    if (got > 0)
      head.append(buffer.data(), static_cast<std::size_t>(got));
    else if (got == 0 || (errno != EAGAIN && errno != EINTR))
      return 0;
  }
  return 200;
}

/// Ends the sending side, and waits for the other one to close: an early end would discard what it has not read yet.
void finish(int connection, const std::atomic<bool>& stop) {
  ::shutdown(connection, SHUT_WR);
  const Clock::time_point deadline = Clock::now() + closing_limit;
  std::array<char, 4096> buffer{};
  while (wait_for(connection, POLLIN, deadline, stop)) {
    const ssize_t got = ::recv(connection, buffer.data(), buffer.size(), 0);
    if (got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR)) return;
  }
}

Status failure_of(const std::string& what) {
  return Status(StatusCode::io_error, what + ": " + std::system_category().message(errno));
}

}  // namespace

LoopbackServer::LoopbackServer(Descriptor listener, int port) : listener_(std::move(listener)), port_(port) {}

Result<LoopbackServer> LoopbackServer::listen(int port) {
  const std::string where = "127.0.0.1:" + std::to_string(port);
  Descriptor listener(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!listener.is_open()) return failure_of("no socket can be made");
  // Lets a port be used again right after its last server has ended, and never two servers share one.
  const int yes = 1;
  ::setsockopt(listener.number(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const auto* const general = reinterpret_cast<const sockaddr*>(&address);
  if (::bind(listener.number(), general, sizeof address) != 0 || ::listen(listener.number(), SOMAXCONN) != 0)
    return failure_of(where + " cannot be listened on");
  socklen_t size = sizeof address;
  if (::getsockname(listener.number(), reinterpret_cast<sockaddr*>(&address), &size) != 0)
    return failure_of(where + " has no address");
  return LoopbackServer(std::move(listener), ntohs(address.sin_port));
}

HttpResponse LoopbackServer::answer(std::string_view head, bool& is_head, const Respond& respond) const {
  HttpRequest request;
  if (const int status = parse_head(head, request); status != 200)
    return text_response(status, "The request is not understood.");
  is_head = request.method == "HEAD";
  constexpr int usual_port = 80;  // which browsers leave out
  const std::string port = port_ == usual_port ? "" : ":" + std::to_string(port_);
  if (request.host != "127.0.0.1" + port && request.host != "localhost" + port)
    return text_response(403, "The host must be 127.0.0.1" + port + ".");
  if (is_head || request.method == "GET") return respond(request);
  HttpResponse refusal = text_response(405, "Files are only read here.");
  refusal.headers.emplace_back("Allow", "GET, HEAD");
  return refusal;
}

void LoopbackServer::serve(const Descriptor& connection, const Respond& respond, const std::atomic<bool>& stop) const {
  std::string head;
  const int status = read_head(connection.number(), head, stop);
  if (status == 0) return;
  bool is_head = false;
  const HttpResponse response =
      status == 200 ? answer(head, is_head, respond) : text_response(status, "The request is too long or too slow.");
  const bool is_file = response.file.is_open();
  const std::string_view text = response.text ? std::string_view(*response.text) : std::string_view();
  if (!send_all(connection.number(), head_of(response, is_file ? response.file_bytes : text.size()), stop)) return;
  if (!is_head && is_file) send_file(connection.number(), response, stop);
  if (!is_head && !is_file && !send_all(connection.number(), text, stop)) return;
  finish(connection.number(), stop);
}

void LoopbackServer::work(const Respond& respond, const std::atomic<bool>& stop) const {
  while (!stop) {
    if (!wait_for(listener_.number(), POLLIN, Clock::now() + 1s, stop)) continue;
    const Descriptor connection(::accept4(listener_.number(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (!connection.is_open()) {
      // Another worker has it, or descriptors are short.
      if (errno != EAGAIN) std::this_thread::sleep_for(slice);
      continue;
    }
    try {
      serve(connection, respond, stop);
    } catch (const std::exception&) {
      // Out of memory: this connection ends, the others go on.
    }
  }
}

Status LoopbackServer::run(const Respond& respond, const std::atomic<bool>& stop,
                           const std::function<void()>& idle) const {
  std::atomic<bool> ends = false;
  std::vector<std::jthread> threads;
  // Before the threads are joined, whatever is thrown.
  const struct End {
    std::atomic<bool>& flag;
    ~End() { flag = true; }
  } end{ends};
  try {
    threads.reserve(workers);
    for (int k = 0; k < workers; ++k) threads.emplace_back([&] { work(respond, ends); });
  } catch (const std::system_error& error) {
    return Status(StatusCode::internal, std::string("no thread can be started: ") + error.what());
  }
  while (!stop) {
    idle();
    std::this_thread::sleep_for(slice);
  }
  return {};
}

}  // namespace tessera::cli
