// The grid by SISL's s1506, in a process of its own (sisl_grid.cpp), which takes its own time.

#include <unistd.h>

#include <csignal>
#include <memory>
#include <stdexcept>

#include "peers/grid_task.h"
#include "peers/sisl_protocol.h"

namespace tessera::bench {
namespace {

/// The program sisl_grid, started for one task.
class Process {
 public:
  explicit Process(const GridTask& task) {
    int in[2], out[2];
    if (pipe(in) != 0 || pipe(out) != 0) throw std::runtime_error("sisl_grid: no pipes");
    const pid_t child = fork();
    if (child < 0) throw std::runtime_error("sisl_grid: no process");
    if (child == 0) {
      dup2(in[0], 0);
      dup2(out[1], 1);
      for (const int end : {in[0], in[1], out[0], out[1]}) close(end);
      execl(TESSERA_SISL_GRID, "sisl_grid", nullptr);
      _exit(127);
    }
    close(in[0]);
    close(out[1]);
    to_ = in[1];
    from_ = out[0];
    send_task(task);
  }
  ~Process() {
    close(to_);  // at which it ends
    close(from_);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  double run() {
    send("r", 1);
    double seconds = 0;
    receive(&seconds, sizeof seconds);
    return seconds;
  }
  GridValue read_point(std::size_t i, std::size_t j) {
    const std::uint64_t place[2] = {i, j};
    double p[9];
    send("v", 1);
    send(place, sizeof place);
    receive(p, sizeof p);
    return {{p[0], p[1], p[2]}, {p[3], p[4], p[5]}, {p[6], p[7], p[8]}};
  }

 private:
  void send_task(const GridTask& task) {
    std::vector<double> numbers;
    for (const Vec3& p : task.net) numbers.insert(numbers.end(), {p.x, p.y, p.z});
    for (std::size_t k = 0; k < task.count(); ++k) numbers.push_back(task.parameter(k));
    const SislTask header{task.side(), static_cast<std::int32_t>(task.count()), task.tangents ? 1 : 0};
    send(&header, sizeof header);
    send(numbers.data(), numbers.size() * sizeof(double));
  }
  void send(const void* bytes, std::size_t size) {
    for (const char* p = static_cast<const char*>(bytes); size > 0;) {
      const ssize_t done = write(to_, p, size);
      if (done <= 0) throw std::runtime_error("sisl_grid has ended");
      p += done;
      size -= static_cast<std::size_t>(done);
    }
  }
  void receive(void* bytes, std::size_t size) {
    for (char* p = static_cast<char*>(bytes); size > 0;) {
      const ssize_t done = read(from_, p, size);
      if (done <= 0) throw std::runtime_error("sisl_grid has ended");
      p += done;
      size -= static_cast<std::size_t>(done);
    }
  }

  int to_ = -1, from_ = -1;
};

const bool registered = [] {
  std::signal(SIGPIPE, SIG_IGN);  // a peer that ends is an error, not the end of us
  grid_peers().push_back({"SISL", [](const GridTask& task) {
                            const auto process = std::make_shared<Process>(task);
                            return std::vector<GridRun>{
                                {"SISL " TESSERA_SISL_VERSION, "s1506", true, [=] { return process->run(); },
                                 [=](std::size_t i, std::size_t j) { return process->read_point(i, j); }}};
                          }});
  return true;
}();

}  // namespace
}  // namespace tessera::bench
