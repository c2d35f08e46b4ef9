#pragma once
// Every public header but ray_embree.h, mpi.h, occt.h and occt_mesh.h, which include the headers of Embree, MPI and
// OpenCASCADE.
//
// Unless a comment says otherwise: arguments are not kept, and results own their memory. Threads: any number of calls
// at once, on different objects or on const ones; work runs in the caller's TBB arena.

#if __cplusplus < 202002L
#error "Tessera needs C++20: compile with -std=c++20 or later"
#endif

#include "tessera/bezier_operations.h"
#include "tessera/bezier_patch.h"
#include "tessera/brep.h"
#include "tessera/colour.h"
#include "tessera/convert.h"
#include "tessera/coons_patch.h"
#include "tessera/curve.h"
#include "tessera/edge_matching.h"
#include "tessera/evaluate.h"
#include "tessera/execution.h"
#include "tessera/generic_callable.h"
#include "tessera/geometry.h"
#include "tessera/gpu_mesh.h"
#include "tessera/guard.h"
#include "tessera/hermite_patch.h"
#include "tessera/limits.h"
#include "tessera/local_geometry.h"
#include "tessera/measures.h"
#include "tessera/mesh.h"
#include "tessera/mesh_assembly.h"
#include "tessera/model.h"
#include "tessera/model_part.h"
#include "tessera/nurbs_surface.h"
#include "tessera/parametric_surface.h"
#include "tessera/patch_set.h"
#include "tessera/quadric.h"
#include "tessera/sections.h"
#include "tessera/status.h"
#include "tessera/strided_view.h"
#include "tessera/surface.h"
#include "tessera/tensor_patch.h"
#include "tessera/tessellate.h"
#include "tessera/tessellation.h"
#include "tessera/tessellation_options.h"
#include "tessera/throw.h"
#include "tessera/topology.h"
#include "tessera/trim_loop.h"
#include "tessera/trim_region.h"
#include "tessera/version.h"

// Headers of the libraries tessera::ray, tessera::io and tessera::parts are installed with these.
#if __has_include("tessera/ray_scene.h")
#include "tessera/nearest_curves.h"
#include "tessera/nearest_points.h"
#include "tessera/queries.h"
#include "tessera/ray_hit.h"
#include "tessera/ray_scene.h"
#include "tessera/solid.h"
#endif
#if __has_include("tessera/io.h")
#include "tessera/cad.h"
#include "tessera/io.h"
#include "tessera/sections_file.h"
#include "tessera/surface_file.h"
#endif
#if __has_include("tessera/transport.h")
#include "tessera/part_hits.h"
#include "tessera/part_mesh.h"
#include "tessera/transport.h"
#endif
