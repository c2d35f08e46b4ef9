#pragma once
// Colours of faces, parts and instances.

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// A colour in sRGB, each value from 0 to 1, as files state it.
struct Colour {
  float red = 0;                                                   ///< 0 to 1
  float green = 0;                                                 ///< 0 to 1
  float blue = 0;                                                  ///< 0 to 1
  float alpha = 1;                                                 ///< 1: opaque
  friend bool operator==(const Colour&, const Colour&) = default;  ///< by all values
};

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
