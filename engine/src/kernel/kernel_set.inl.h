// All kernels over this unit's Lanes, and their table. The last include of each isa_*.cpp.

inline constexpr int max_order = 16;  // coefficients of the highest degree

#include "kernel/transpose.inl.h"
#include "kernel/sample_kernel.inl.h"
#include "kernel/normal_kernel.inl.h"
#include "kernel/curvature_kernel.inl.h"
#include "kernel/grid_kernel.inl.h"
#include "kernel/line_kernel.inl.h"
#include "kernel/border_kernel.inl.h"
#include "kernel/blend_kernel.inl.h"
#include "kernel/net_kernel.inl.h"
#include "kernel/memory_kernels.inl.h"
#include "kernel/lane_weights.inl.h"
#include "kernel/locate_kernel.inl.h"
#include "kernel/point_slots.inl.h"
#include "kernel/point_kernel.inl.h"
#include "kernel/point_store.inl.h"
#include "kernel/chord_kernel.inl.h"
#include "kernel/mesh_kernel.inl.h"
#include "kernel/mesh_index.inl.h"
#include "kernel/border_hash.inl.h"

constexpr KernelTable table = {
    this_isa,
    evaluate_grid<Lanes<float>>,
    evaluate_grid<Lanes<double>>,
    evaluate_border<Lanes<float>>,
    begin_lines<Lanes<float>>,
    begin_lines<Lanes<double>>,
    put_lines<Lanes<float>>,
    put_lines<Lanes<double>>,
    end_lines<Lanes<float>>,
    end_lines<Lanes<double>>,
    blend<Lanes<float>>,
    blend<Lanes<double>>,
    pack_nets<float>,
    pack_nets<double>,
    bound_nets,
    bound_points,
    combine_rows,
    evaluate_points<Lanes<float>>,
    evaluate_points<Lanes<double>>,
    check_points<float>,
    check_points<double>,
    locate,
    store_points<Lanes<float>>,
    store_points<Lanes<double>>,
    hash_borders<Lanes<float>>,
    bound_chords<Lanes<float>>,
    find_rates<Lanes<float>>,
    write_mesh_vertices<Lanes<float>>,
    write_mesh_indices<Lanes<float>>,
    stream_lines<Lanes<float>>,
    fma_rate<Lanes<float>>,
    fma_rate<Lanes<double>>,
    fill_memory<Lanes<float>>,
    finish_streaming<Lanes<float>>,
};
