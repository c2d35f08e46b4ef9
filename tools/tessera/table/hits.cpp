#include "table/hits.h"

#include <string_view>

#include "table/csv.h"
#include "tessera/surface.h"

namespace tessera::cli {
namespace {

constexpr std::string_view header = "ray,hit,t,surface,patch,u,v,x,y,z,nx,ny,nz,edge,name\n";

void write_miss(OutputFile& out, std::size_t ray) {
  out.write_number(ray);
  out.write(",0,,,,,,,,,,,,,\n");
}

void write_hit(OutputFile& out, std::size_t ray, const Hit& hit, const std::string& name) {
  constexpr int digits = 17;
  out.write_number(ray);
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
  out.write(hit.flags.edge ? ",1," : ",0,");
  write_field(out, name);
  out.write('\n');
}

}  // namespace

HitCounts use_own_parameters(const Model& model, HitLists& lists) {
  HitCounts counts{.rays = lists.first.size() - 1, .points = lists.hits.size()};
  for (std::size_t ray = 0; ray < counts.rays; ++ray) counts.hits += lists.first[ray + 1] > lists.first[ray];
  for (Hit& hit : lists.hits) {
    const auto own = own_parameters(model.surfaces[hit.surface].surface, hit.u, hit.v);
    hit.u = own[0];
    hit.v = own[1];
    counts.unrefined += hit.flags.unrefined;
    counts.uncertified += hit.flags.uncertified;
    counts.incomplete += hit.flags.incomplete;
    counts.edge += hit.flags.edge;
  }
  return counts;
}

void write_hits(OutputFile& out, const Model& model, const HitLists& lists) {
  out.write(header);
  for (std::size_t ray = 0; ray + 1 < lists.first.size() && !out.failed(); ++ray) {
    if (lists.first[ray] == lists.first[ray + 1]) write_miss(out, ray);
    for (std::size_t k = lists.first[ray]; k < lists.first[ray + 1]; ++k)
      write_hit(out, ray, lists.hits[k], model.surfaces[lists.hits[k].surface].name);
  }
}

}  // namespace tessera::cli
