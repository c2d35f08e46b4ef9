// The kernel tables of one instruction set, which its units define, and the table of them all. Included by
// machine_*.cpp inside the ISA's namespace, after this_isa.

extern const GridKernels grid_kernels;
extern const DoubleGridKernels double_grid_kernels;
extern const FlatKernels flat_kernels;
extern const LineKernels line_kernels;
extern const NetKernels net_kernels;
extern const PointKernels point_kernels;
extern const ChordKernels chord_kernels;
extern const MeshKernels mesh_kernels;
extern const RayKernels ray_kernels;
extern const MemoryKernels memory_kernels;

inline const KernelTable& table() {
  static const KernelTable all{grid_kernels, double_grid_kernels, flat_kernels,  line_kernels,
                               net_kernels,  point_kernels,       chord_kernels, mesh_kernels,
                               ray_kernels,  memory_kernels,      this_isa};
  return all;
}
