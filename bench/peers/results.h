#pragma once
// The results of a comparison, for one table of all: each is a line of JSON in the file that the environment names as
// TESSERA_PEERS_RESULTS (tools/peers.sh). Without that variable nothing is written.

#include <cstdio>
#include <cstdlib>
#include <string>

namespace tessera::bench {

struct PeerResult {
  std::string task;     ///< "positions, 9 x 9 per span"
  std::string peer;     ///< name and version
  std::string way;      ///< the function, the precision
  double rate = 0;      ///< the peer's, items per second
  std::string against;  ///< the way of Tessera
  double ratio = 0;     ///< Tessera's rate over the peer's
  bool main = true;     ///< whether this ratio stands for the peer, if there are several
};

inline void add_result(const PeerResult& r) {
  const char* name = std::getenv("TESSERA_PEERS_RESULTS");
  if (name == nullptr || *name == '\0') return;
  std::FILE* file = std::fopen(name, "a");
  if (file == nullptr) return static_cast<void>(std::fprintf(stderr, "%s can't be written\n", name));
  std::fprintf(
      file,
      "{\"task\": \"%s\", \"peer\": \"%s\", \"way\": \"%s\", \"rate\": %.6g, \"against\": \"%s\", \"ratio\": %.4g, "
      "\"main\": %s}\n",
      r.task.c_str(), r.peer.c_str(), r.way.c_str(), r.rate, r.against.c_str(), r.ratio, r.main ? "true" : "false");
  std::fclose(file);
}

}  // namespace tessera::bench
