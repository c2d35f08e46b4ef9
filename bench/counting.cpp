#include "counting.h"

#if __has_include(<valgrind/callgrind.h>)
#include <valgrind/callgrind.h>
#define TESSERA_HAS_CALLGRIND
#endif

namespace tessera::bench {
namespace {

bool is_counting = false;
std::string current;

constexpr std::string_view cases[] = {
    // Much of a plan's work is malloc, whose instructions depend on what was freed before: by other cases, and even for
    // names of files, which are longer in one checkout than in another. So these are the first.
    "small.plan/bicubic4/3/9x9",
    "small.grid/bicubic4/3/9x9",
    "evaluate.positions.blocks/bicubic1000/3/9x9",
    "evaluate.positions.interleaved/bicubic1000/3/9x9",
    "evaluate.positions+normals.blocks/bicubic1000/3/9x9",
    "evaluate.positions+normals.interleaved/bicubic1000/3/9x9",
    "evaluate.positions+normals.interleaved/teapot/3/33x33",
    "evaluate.positions+du+dv.blocks/bicubic1000/3/9x9",
    "evaluate.positions+du+dv.interleaved/bicubic1000/3/9x9",
    "evaluate.curvatures.blocks/bicubic1000/3/9x9",
    "evaluate.curvatures.interleaved/bicubic1000/3/9x9",
    "evaluate.geometry.blocks/teapot/3/33x33",
    "evaluate.positions.blocks/rational1000/3r/9x9",
    "evaluate.positions.interleaved.double/bicubic20000/3/9x9",
    "points.positions.random/bicubic5000/3/400000",
    "points.positions+normals.runs40/bicubic5000/3/400000",
    "update.positions+normals.one_in_20/bicubic10000/3/9x9",
    "transfinite.float.interleaved/coons-curves/-/1024x1024",
    "extract/bspline/3/200x200",
    "extract/nurbs/3/200x200",
    "convert.elevate/bicubic1000/3/to5",
    "convert.elevate/bspline/3/50x50",
    "convert.hermite/network/3/32x32",
    "convert.coons/bspline/3/64x64",
    "convert.ruled/nurbs/3r/64",
    "convert.fit/callable/3/1e-6",
    "pack/bicubic20000/3/20000",
    "pack.rational/bicubic20000/3r/20000",
    "pack.points/bicubic20000/3/20000",
    "pack.power/bicubic20000/3/20000",
    "tessellate/bicubic20000/3/8x8",
    "update.mesh+bounds.one_in_20/bicubic10000/3/rate8",
    "certified.mesh/bicubic20000/3/rate8",
    "certified.mesh/bicubic25/3/rate8",
    "ray.closest.camera/teapot/3/65536",
    "ray.occluded.random/teapot/3/65536",
    "ray.exact.closest.coherent/torus3600/3/65536",
    "ray.exact.batch.t+uv+patch/torus3600/3/65536",
    "ray.refit/teapot/3/rate8",
    "read.bpt/bicubic/3/1MB",
    "read.bv/bicubic/3/1MB",
    "read.g2/bspline/3/1MB",
    "read.json/bicubic/3/1MB",
    "read.obj/bspline/3/1MB",
    "read.rib/bicubic/3/1MB",
    "closed.mesh/wavy.faces64/3/0.02",
    "closed.mesh/plate8x8/-/1e-3",
};

}  // namespace

std::span<const std::string_view> counted_cases() { return cases; }

bool counting() { return is_counting; }
void start_counting() { is_counting = true; }
void name_count(const std::string& name) { current = name; }

#ifdef TESSERA_HAS_CALLGRIND
bool under_valgrind() { return RUNNING_ON_VALGRIND != 0; }
void begin_count() {
  CALLGRIND_START_INSTRUMENTATION;
  CALLGRIND_ZERO_STATS;
}
void end_count() {
  CALLGRIND_STOP_INSTRUMENTATION;
  CALLGRIND_DUMP_STATS_AT(current.c_str());
}
#else
bool under_valgrind() { return false; }
void begin_count() {}
void end_count() {}
#endif

}  // namespace tessera::bench
