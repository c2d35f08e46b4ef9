#include "facts/counts.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <system_error>

#include "console/console.h"

namespace tessera::cli {
namespace {

/// The bytes of an array's elements.
template <class Array>
std::size_t array_bytes(const Array& array) {
  return array.size() * sizeof(*array.data());
}

std::size_t bytes_of(const Curve& curve) {
  return sizeof curve + array_bytes(curve.points()) + array_bytes(curve.weights()) + array_bytes(curve.knots());
}

std::size_t bytes_of(const BorderCurve& border) {
  const Curve* const curve = std::get_if<Curve>(&border);
  return curve ? bytes_of(*curve) : 0;
}

/// The bytes of a surface's arrays, by its kind. Memory that copies share counts with each copy.
template <class Kind>
std::size_t net_bytes(const Kind& kind) {
  std::size_t bytes = 0;
  if constexpr (requires { kind.points(); }) bytes += array_bytes(kind.points());
  if constexpr (requires { kind.weights(); }) bytes += array_bytes(kind.weights());
  if constexpr (requires { kind.geometry(); }) bytes += array_bytes(kind.geometry());
  if constexpr (requires { kind.knots_u(); }) bytes += array_bytes(kind.knots_u()) + array_bytes(kind.knots_v());
  if constexpr (requires { kind.first().index(); }) bytes += bytes_of(kind.first()) + bytes_of(kind.second());
  if constexpr (requires { kind.borders(); }) {
    const CoonsBorders& of = kind.borders();
    bytes += bytes_of(of.c1) + bytes_of(of.c2) + bytes_of(of.d1) + bytes_of(of.d2);
  }
  return bytes;
}

std::size_t bytes_of(const ModelSurface& surface) {
  std::size_t bytes = sizeof surface + surface.name->size();
  bytes += std::visit([](const auto& kind) { return net_bytes(kind); }, surface.surface);
  for (const TrimLoop& loop : *surface.trims) {
    bytes += sizeof loop;
    for (const Curve& curve : loop.curves) bytes += bytes_of(curve);
  }
  return bytes;
}

void widen(Range& range, double from, double to, bool first) {
  range.least = first ? from : std::min(range.least, from);
  range.largest = first ? to : std::max(range.largest, to);
}

void count_surfaces(const Model& model, ModelCounts& counts) {
  bool first = true;
  for (const ModelSurface& surface : model.surfaces) {
    ++counts.kinds[kind_name(surface.surface)];
    counts.model_bytes += bytes_of(surface);
    const Domain d = domain(surface.surface);
    counts.on_unit_square += d == Domain{};
    widen(counts.u, d.u0, d.u1, first);
    widen(counts.v, d.v0, d.v1, first);
    first = false;
  }
}

void count_patches(const PatchSet& set, ModelCounts& counts) {
  for (std::size_t k = 0; k < set.patch_count(); ++k) {
    const BezierPatch& patch = set.patch(k);
    ++counts.degrees[{patch.degree_u(), patch.degree_v()}];
    counts.rational += patch.is_rational();
    counts.control_points += patch.points().size();
    counts.patch_bytes +=
        sizeof patch + sizeof(PatchSource) + array_bytes(patch.points()) + array_bytes(patch.weights());
    const SideMask collapsed = patch.collapsed_sides();
    for (const Side side : {Side::v0, Side::u1, Side::v1, Side::u0}) counts.collapsed_sides += collapsed.has(side);
    counts.patches_with_collapsed_sides += collapsed.any();
  }
  const std::size_t all = set.memory_bytes();
  counts.block_bytes = all - std::min(all, counts.patch_bytes);
}

}  // namespace

ModelCounts count_model(const Model& model, const PatchSet& set) {
  ModelCounts counts;
  count_surfaces(model, counts);
  count_patches(set, counts);
  return counts;
}

std::optional<std::uintmax_t> file_bytes(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return {};
  const std::uintmax_t bytes = std::filesystem::file_size(path, error);
  if (error) return {};
  return bytes;
}

}  // namespace tessera::cli
