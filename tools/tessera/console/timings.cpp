#include "console/timings.h"

#include <algorithm>

namespace tessera::cli {

void Timings::add(std::string_view name, double seconds) {
  const auto known =
      std::find_if(phases_.begin(), phases_.end(), [&](const auto& phase) { return phase.first == name; });
  if (known == phases_.end()) {
    phases_.emplace_back(name, seconds);
  } else {
    known->second += seconds;
  }
}

std::string Timings::as_text() const {
  std::string text;
  for (const auto& [name, seconds] : phases_) {
    text += (text.empty() ? "" : ", ") + std::string(name) + " " + readable_seconds(seconds);
  }
  return text + (text.empty() ? "" : "; ") + readable_seconds(all_.seconds()) + " in all";
}

Json Timings::as_json() const {
  Json json = Json::object();
  for (const auto& [name, seconds] : phases_) json[std::string(name)] = seconds;
  json["total"] = all_.seconds();
  return json;
}

}  // namespace tessera::cli
