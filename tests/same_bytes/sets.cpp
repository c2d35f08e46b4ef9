#include <array>
#include <memory>

#include <tessera/evaluate.h>
#include <tessera/model.h>
#include <tessera/tessellation.h>

#include "families.h"
#include "hash.h"
#include "models.h"

using tessera::Isa;

namespace {

/// Room for every output.
template <class T>
struct Outputs {
  explicit Outputs(std::size_t records) {
    for (auto& vectors : threes) vectors.resize(3 * records);
    for (auto& scalars : ones) scalars.resize(records);
    normal_kind.resize(records);
    curvature_kind.resize(records);
  }
  tessera::QuantityViews<T> views() {
    using Three = tessera::View3<T>;
    using One = tessera::View1<T>;
    tessera::QuantityViews<T> all;
    const std::array<Three*, 11> three{&all.position,
                                       &all.du,
                                       &all.dv,
                                       &all.normal,
                                       &all.duu,
                                       &all.duv,
                                       &all.dvv,
                                       &all.first_form,
                                       &all.second_form,
                                       &all.first_direction,
                                       &all.second_direction};
    for (std::size_t k = 0; k < three.size(); ++k) *three[k] = Three::interleaved(threes[k]);
    const std::array<One*, 4> one{&all.gaussian, &all.mean, &all.first_curvature, &all.second_curvature};
    for (std::size_t k = 0; k < one.size(); ++k) *one[k] = One::interleaved(ones[k]);
    all.normal_kind = tessera::View1<tessera::NormalKind>::interleaved(normal_kind);
    all.curvature_kind = tessera::View1<tessera::CurvatureKind>::interleaved(curvature_kind);
    return all;
  }
  std::uint64_t hash() const {
    Hash hash;
    for (const auto& vectors : threes) hash.add(vectors);
    for (const auto& scalars : ones) hash.add(scalars);
    hash.add(normal_kind);
    hash.add(curvature_kind);
    return hash.value();
  }
  std::array<std::vector<T>, 11> threes;
  std::array<std::vector<T>, 4> ones;
  std::vector<tessera::NormalKind> normal_kind;
  std::vector<tessera::CurvatureKind> curvature_kind;
};

template <class T, tessera::Representation representation>
std::uint64_t grid(Isa isa) {
  const tessera::PatchSet set = some_set();
  const auto u = tessera::uniform_parameters(9), v = tessera::uniform_parameters(22);
  tessera::GridPlanOptions options;
  options.precision = sizeof(T) == 4 ? tessera::Precision::single_precision : tessera::Precision::double_precision;
  options.representation = representation;
  options.isa = isa;
  const tessera::GridPlan plan = value_of(tessera::GridPlan::make(set, u, v, options));
  Outputs<T> out(plan.capacity());
  require(evaluate(set, plan, out.views()));
  return out.hash();
}

/// Positions alone have kernels of their own, patch after patch and in blocks.
template <class T>
std::uint64_t positions(Isa isa) {
  const tessera::PatchSet set = some_set();
  const auto u = tessera::uniform_parameters(9), v = tessera::uniform_parameters(22);
  tessera::GridPlanOptions options;
  options.precision = sizeof(T) == 4 ? tessera::Precision::single_precision : tessera::Precision::double_precision;
  options.isa = isa;
  const tessera::GridPlan plan = value_of(tessera::GridPlan::make(set, u, v, options));
  Hash hash;
  std::vector<T> records(3 * plan.capacity());
  tessera::QuantityViews<T> views;
  views.position = tessera::View3<T>::interleaved(records);
  require(evaluate(set, plan, views));
  hash.add(records);
  std::vector<T> memory(plan.block_capacity() + 64 / sizeof(T));
  void* aligned = memory.data();
  std::size_t space = memory.size() * sizeof(T);
  std::align(64, plan.block_capacity() * sizeof(T), aligned, space);
  tessera::QuantityBlocks<T> blocks;
  blocks.position = {static_cast<T*>(aligned), plan.block_capacity()};
  require(evaluate(set, plan, blocks));
  for (const T x : blocks.position) hash.add(x);
  return hash.value();
}

template <class T>
std::uint64_t points(Isa isa) {
  const tessera::PatchSet set = some_set();
  Seeded seeded(7);
  std::vector<std::uint32_t> patch(5000);
  std::vector<T> u(patch.size()), v(patch.size());
  for (std::size_t k = 0; k < patch.size(); ++k) {
    patch[k] = static_cast<std::uint32_t>(seeded.word() % set.patch_count());
    u[k] = static_cast<T>(seeded.unit());
    v[k] = static_cast<T>(seeded.unit());
  }
  tessera::PatchSamples<T> samples;
  samples.patch = tessera::View1<const std::uint32_t>::interleaved(patch);
  samples.u = tessera::View1<const T>::interleaved(u);
  samples.v = tessera::View1<const T>::interleaved(v);
  tessera::PointOptions options;
  options.isa = isa;
  Outputs<T> out(patch.size());
  require(evaluate(set, samples, out.views(), options));
  return out.hash();
}

void add(Hash& hash, const tessera::Mesh& mesh) {
  hash.add(mesh.positions);
  hash.add(mesh.normals);
  hash.add(mesh.parameters);
  hash.add(mesh.patches);
  hash.add(mesh.indices);
}

std::uint64_t mesh(Isa isa) {
  const tessera::PatchSet set = some_set();
  const auto plan = value_of(tessera::Tessellation::make(set, {.rates = tessera::UniformRates{5, 11}, .isa = isa}));
  tessera::Mesh out = value_of(plan.allocate());
  require(plan.run(set, out.views()));
  Hash hash;
  add(hash, out);
  return hash.value();
}

/// Fits and circles among them, which use sines.
tessera::PatchSet fitted_set() {
  std::vector<tessera::PatchGrid> grids;
  for (const tessera::Surface& surface : some_surfaces())
    grids.push_back(value_of(tessera::to_bezier(surface, {.tolerance = 1e-5})));
  return value_of(tessera::make_patch_set(grids));
}

}  // namespace

std::uint64_t certified_hash(const tessera::PatchSet& set, double tolerance, Isa isa) {
  tessera::TessellationOptions options;
  options.tolerance = tolerance;
  options.angle = 0.3;
  options.joining.weld = 1e-6;
  options.parameters = tessera::VertexParameters::patch;
  options.isa = isa;
  const auto plan = value_of(tessera::Tessellation::make(set, options));
  tessera::Mesh out = value_of(plan.allocate());
  require(plan.run(set, out.views()));
  Hash hash;
  add(hash, out);
  for (const float bound : plan.bounds()) hash.add(bound);
  for (const float angle : plan.angles()) hash.add(angle);
  return hash.value();
}

std::vector<Family> set_families() {
  using enum tessera::Representation;
  return {{"grid_float", grid<float, bernstein>},
          {"grid_double", grid<double, bernstein>},
          {"power_float", grid<float, power>},
          {"power_double", grid<double, power>},
          {"positions_float", positions<float>},
          {"positions_double", positions<double>},
          {"points_float", points<float>},
          {"points_double", points<double>},
          {"mesh", mesh},
          {"certified_patches", [](Isa isa) { return certified_hash(some_set(), 3e-3, isa); }},
          {"certified_fits", [](Isa isa) { return certified_hash(fitted_set(), 3e-3, isa); }}};
}
