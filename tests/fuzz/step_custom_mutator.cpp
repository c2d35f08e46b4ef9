// libFuzzer's mutations of STEP texts: those of StepMutator, which knows instances, references and numbers.

#include <algorithm>
#include <cstring>

#include "io_step/step_mutator.h"

extern "C" std::size_t LLVMFuzzerMutate(unsigned char* data, std::size_t size, std::size_t max_size);

extern "C" std::size_t LLVMFuzzerCustomMutator(unsigned char* data, std::size_t size, std::size_t max_size,
                                               unsigned int seed) {
  if (seed % 16 == 0) return LLVMFuzzerMutate(data, size, max_size);
  const std::string text = tessera::test::StepMutator(seed).mutated({reinterpret_cast<const char*>(data), size});
  const std::size_t length = std::min(text.size(), max_size);
  std::memcpy(data, text.data(), length);
  return length;
}
