#pragma once
// Sentences about faults of a STEP file that leave the rest of it usable.

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace tessera { inline namespace abi_0_1 {

/// The first sentences, and the number of all.
struct StepRemarks {
  static constexpr std::size_t max_texts = 100;  ///< more are counted only
  std::vector<std::string> texts;                ///< one sentence each, mostly with an instance and its line
  std::size_t count = 0;                         ///< of all

  void add(std::string text) {
    if (count++ < max_texts) texts.push_back(std::move(text));
  }
};

}}  // namespace tessera::abi_0_1
