#pragma once
// The faces of shapes that a model's surfaces are.

#include <algorithm>
#include <cstddef>
#include <optional>

#include "tessera/model.h"

namespace tessera { inline namespace abi_0_1 {

/// A face at its place.
struct SurfaceFace {
  const Instance* instance = nullptr;
  const ShapeFace* face = nullptr;

  /// Returns the face's colour, or else its instance's.
  const std::optional<Colour>& colour() const { return face->colour ? face->colour : instance->colour; }
};

/// Returns the face that a surface is; nothing if it is no instance's.
inline std::optional<SurfaceFace> face_of_surface(const Model& model, std::size_t surface) {
  const auto after = std::ranges::upper_bound(model.instances, surface, {}, &Instance::first_surface);
  if (after == model.instances.begin()) return {};
  const Instance& instance = after[-1];
  const std::size_t face = surface - instance.first_surface;
  if (instance.shape >= model.shapes.size() || face >= model.shapes[instance.shape].faces.size()) return {};
  return SurfaceFace{&instance, &model.shapes[instance.shape].faces[face]};
}

}}  // namespace tessera::abi_0_1
