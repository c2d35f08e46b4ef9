#include "hits_table.h"

#include <string_view>

#include "tessera/surface.h"

namespace tessera::cli {
namespace {

constexpr std::string_view header = "ray,hit,t,surface,patch,u,v,x,y,z,nx,ny,nz\n";

void write_hit(OutputFile& out, std::size_t ray, const Hit& hit) {
  constexpr int digits = 17;
  out.write_number(ray);
  if (hit.kind != HitKind::hit) return out.write(",0,,,,,,,,,,,\n");
  out.write(",1,");
  out.write_number(hit.t, digits);
  out.write(',');
  out.write_number(hit.surface);
  out.write(',');
  out.write_number(hit.patch);
  for (const double value :
       {hit.u, hit.v, hit.position.x, hit.position.y, hit.position.z, hit.normal.x, hit.normal.y, hit.normal.z}) {
    out.write(',');
    out.write_number(value, digits);
  }
  out.write('\n');
}

}  // namespace

HitCounts use_own_parameters(const Model& model, std::span<Hit> hits) {
  HitCounts counts{.rays = hits.size()};
  for (Hit& hit : hits) {
    if (hit.kind != HitKind::hit) continue;
    const auto own = own_parameters(model.surfaces[hit.surface].surface, hit.u, hit.v);
    hit.u = own[0];
    hit.v = own[1];
    ++counts.hits;
    counts.unrefined += hit.flags.unrefined;
  }
  return counts;
}

void write_hits(OutputFile& out, std::span<const Hit> hits) {
  out.write(header);
  for (std::size_t k = 0; k < hits.size() && !out.failed(); ++k) write_hit(out, k, hits[k]);
}

}  // namespace tessera::cli
