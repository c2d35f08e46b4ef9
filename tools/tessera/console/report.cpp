#include "console/report.h"

#include <cstdio>

#include "console/output.h"

namespace tessera::cli {

Status Report::print(const std::string& output, const CommonOptions& options, const Timings& timings) {
  if (options.timings) add("seconds", timings.as_json());
  const std::string text = (options.json ? object_.text() : words_) + "\n";
  if (!is_stream(output)) return cli::print(text);
  std::fwrite(text.data(), 1, text.size(), stderr);
  return {};
}

}  // namespace tessera::cli
