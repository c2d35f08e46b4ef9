#pragma once
// A peer in a process of its own, connected by pipes; numbers are in the machine's own format.

#include <unistd.h>

#include <csignal>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace tessera::bench {

/// A started program; it ends when its input does. Throws std::runtime_error if it cannot be started or has ended.
class ChildProcess {
 public:
  explicit ChildProcess(const std::string& program) : program_(program) {
    std::signal(SIGPIPE, SIG_IGN);  // a peer that ends is an error, but must not end this process
    int in[2], out[2];
    if (pipe(in) != 0 || pipe(out) != 0) throw std::runtime_error(program_ + ": no pipes");
    const pid_t child = fork();
    if (child < 0) throw std::runtime_error(program_ + ": no process");
    if (child == 0) {
      dup2(in[0], 0);
      dup2(out[1], 1);
      for (const int end : {in[0], in[1], out[0], out[1]}) close(end);
      execl(program_.c_str(), program_.c_str(), nullptr);
      _exit(127);
    }
    close(in[0]);
    close(out[1]);
    to_ = in[1];
    from_ = out[0];
  }
  ~ChildProcess() {
    close(to_);
    close(from_);
  }
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  template <class T>
  void send(const T* values, std::size_t count) {
    std::size_t size = count * sizeof(T);
    for (const char* p = reinterpret_cast<const char*>(values); size > 0;) {
      const ssize_t done = write(to_, p, size);
      if (done <= 0) throw std::runtime_error(program_ + " has ended");
      p += done;
      size -= static_cast<std::size_t>(done);
    }
  }
  template <class T>
  void receive(T* values, std::size_t count) {
    std::size_t size = count * sizeof(T);
    for (char* p = reinterpret_cast<char*>(values); size > 0;) {
      const ssize_t done = read(from_, p, size);
      if (done <= 0) throw std::runtime_error(program_ + " has ended");
      p += done;
      size -= static_cast<std::size_t>(done);
    }
  }

 private:
  std::string program_;
  int to_ = -1, from_ = -1;
};

}  // namespace tessera::bench
