#pragma once
// A server of HTTP on the loopback address, for a browser on this machine.

#include <atomic>
#include <functional>
#include <string>

#include "io/file/descriptor.h"
#include "serve/http.h"
#include "tessera/status.h"

namespace tessera::cli {

/// Listens on 127.0.0.1 alone. Each connection serves one GET or HEAD. A page elsewhere whose name leads to this
/// machine (DNS rebinding) gets nothing, because the Host header must be 127.0.0.1 or localhost with the port.
class LoopbackServer {
 public:
  using Respond = std::function<HttpResponse(const HttpRequest&)>;

  /// Listens on `port`; on a free one if it is 0. Errors: io_error (the port is occupied, or not for this user).
  static Result<LoopbackServer> listen(int port);

  int port() const { return port_; }
  /// Answers requests until `stop`. `respond` answers those with a right host and method, on several threads at once.
  /// `idle` is called about every 50 ms, on the calling thread. Errors: internal (no thread can be started).
  Status run(const Respond& respond, const std::atomic<bool>& stop, const std::function<void()>& idle) const;

 private:
  LoopbackServer(Descriptor listener, int port);
  void work(const Respond& respond, const std::atomic<bool>& stop) const;
  HttpResponse answer(std::string_view head, bool& is_head, const Respond& respond) const;
  void serve(const Descriptor& connection, const Respond& respond, const std::atomic<bool>& stop) const;

  Descriptor listener_;
  int port_ = 0;
};

}  // namespace tessera::cli
