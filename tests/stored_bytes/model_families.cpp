#include "stored_bytes/model_families.h"

#include <tessera/evaluate.h>
#include <tessera/io.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "same_bytes/hash.h"

namespace {

using tessera::Isa;

/// Positions, derivatives and normals in float.
std::uint64_t grid_hash(const tessera::PatchSet& set, Isa isa) {
  const auto u = tessera::uniform_parameters(9), v = tessera::uniform_parameters(14);
  const tessera::GridPlan plan = value_of(tessera::GridPlan::make(set, u, v, {.isa = isa}));
  std::vector<float> position(3 * plan.capacity()), du(position), dv(position), normal(position);
  using View = tessera::View3<float>;
  require(evaluate(set, plan,
                   tessera::QuantityViews<float>{View::interleaved(position), View::interleaved(du),
                                                 View::interleaved(dv), View::interleaved(normal)}));
  Hash hash;
  for (const auto* values : {&position, &du, &dv, &normal}) hash.add(*values);
  return hash.value();
}

tessera::PatchSet set_of(const std::filesystem::path& file) {
  return value_of(tessera::make_patch_set(value_of(tessera::read_model(file))));
}

/// Models whose results change if sin, cos, exp, atan2, pow or hypot change by a unit in the last place. All quadrics
/// call such functions too, whether or not their results show it.
bool depends_on_libm(const std::string& name) {
  constexpr std::array names{
      "catenoid",           "coons_bilinear_parabolas", "coons_own_blends", "cylinder",   "enneper", "helicoid",
      "hemisphere",         "hemisphere_stereographic", "moebius_band",     "paraboloid", "plane",   "ripple",
      "ruled_arc_parabola", "ruled_parabola_sine",      "seashell"};
  return name.starts_with("quadric_") || std::ranges::find(names, name) != names.end();
}

}  // namespace

std::vector<Family> model_families() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(TESSERA_SOURCE_DIR "/tools/models"))
    if (entry.path().extension() == ".json" || entry.path().extension() == ".bpt") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<Family> families;
  for (const std::filesystem::path& file : files) {
    const std::string name = file.stem();
    if (depends_on_libm(name) || name.starts_with("trimmed_")) continue;  // trims have tests of their own
    families.push_back({name + ".grid", [file](Isa isa) { return grid_hash(set_of(file), isa); }});
    families.push_back({name + ".mesh", [file](Isa isa) {
                          const tessera::PatchSet set = set_of(file);
                          return certified_hash(set, 3e-3 * set.box().diagonal(), isa);
                        }});
    families.push_back({name + ".hits", [file](Isa isa) { return hits_hash(set_of(file), 500, true, isa); }});
  }
  return families;
}
