// Denormal numbers count on all processors but those of flush_denormals_x86.cpp.

#include "ray/line/flush_denormals.h"

namespace tessera { inline namespace abi_0_1 {

FlushDenormals::FlushDenormals() : saved_(0) {}
FlushDenormals::~FlushDenormals() = default;

CountDenormals::CountDenormals() : saved_(0) {}
CountDenormals::~CountDenormals() = default;

}}  // namespace tessera::abi_0_1
