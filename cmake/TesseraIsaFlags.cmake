# Compiles the units of the floor `kernel` once for each instruction set of the target processor.
# - Each instruction set has a target tessera_kernel_ISA; sse2 has two, because its units have different flags.
# - tessera_isa_objects lists the objects of all of them.
# - tessera_machine is the source that finds out at run time which instruction sets the machine has.
#
# No other file sets flags of instruction sets. The units are optimised in every configuration: otherwise small inline
# functions would remain as symbols, which the linker could merge into the baseline. Sanitized builds use -O1, because
# at -O3 the compiler takes minutes for their checks.
set(TESSERA_KERNEL_LEVEL "-O3" CACHE STRING "How the kernels are optimised: another level than -O3 is for tests of compilers alone")
mark_as_advanced(TESSERA_KERNEL_LEVEL)
set(kernel_flags ${TESSERA_KERNEL_LEVEL} -fno-trapping-math -fno-exceptions)
if(TESSERA_SANITIZE)
  list(TRANSFORM kernel_flags REPLACE "^-O3$" -O1)
endif()
get_filename_component(kernel_folder ${CMAKE_CURRENT_LIST_DIR}/../engine/src/kernel ABSOLUTE)
set(kernel_units grid/unit_grid grid/unit_grid_double grid/unit_flat grid/unit_line net/unit_net point/unit_point
  chord/unit_chord chord/unit_chord_any mesh/unit_mesh)
if(TESSERA_BUILD_RAY)
  list(APPEND kernel_units ray/unit_ray)
else()
  list(APPEND kernel_units ray/unit_no_ray)
endif()
list(TRANSFORM kernel_units PREPEND ${kernel_folder}/)
list(TRANSFORM kernel_units APPEND .cpp)
set(less_code)
if(TESSERA_KERNEL_LEVEL STREQUAL -O3 AND NOT TESSERA_SANITIZE)
  set(less_code -O2)
endif()
# Its loops run over a degree that is not known at compile time, so unrolling gains nothing.
set_source_files_properties(${kernel_folder}/chord/unit_chord_any.cpp PROPERTIES COMPILE_OPTIONS "${less_code}")

# tessera_isa(NAME "units" flags...)
macro(tessera_isa name units)
  tessera_floor(kernel_${name} SOURCES ${units} BELOW base)
  target_compile_options(tessera_kernel_${name} PRIVATE ${kernel_flags} ${ARGN}
    # Arrays are filled as far as a degree goes, which gcc 14 does not see.
    $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_GREATER_EQUAL:$<CXX_COMPILER_VERSION>,13>>:-Wno-maybe-uninitialized>)
  if(TARGET xsimd)
    target_link_libraries(tessera_kernel_${name} PRIVATE xsimd)
  endif()
  set_target_properties(tessera_kernel_${name} PROPERTIES UNITY_BUILD OFF)
  list(APPEND tessera_isa_objects $<TARGET_OBJECTS:tessera_kernel_${name}>)
endmacro()

if(CMAKE_SYSTEM_PROCESSOR STREQUAL "wasm32")  # -O3 makes the module larger and no faster
  list(TRANSFORM kernel_flags REPLACE "^-O3$" -O2)
  set(tessera_machine ${kernel_folder}/table/machine_wasm32.cpp)
  tessera_isa(wasm128 "${kernel_units}" -msimd128)
elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "^(aarch64|arm64)$")
  set(tessera_machine ${kernel_folder}/table/machine_aarch64.cpp)
  tessera_isa(neon64 "${kernel_units}")
else()
  set(tessera_machine ${kernel_folder}/table/machine_x86.cpp)
  # Few machines lack AVX2. For these, plans and meshes are compiled at -O2: half the code, a quarter slower. Grids and
  # points stay at -O3: at -O2 they have a tenth less code, but take twice the time.
  set(mesh_units ${kernel_units})
  list(FILTER mesh_units INCLUDE REGEX "unit_(chord|mesh)\\.cpp$")
  set(other_units ${kernel_units})
  list(REMOVE_ITEM other_units ${mesh_units})
  tessera_isa(sse2 "${other_units}" -msse2)
  tessera_isa(sse2_mesh "${mesh_units}" -msse2 ${less_code})
  tessera_isa(avx2 "${kernel_units}" -mavx2 -mfma)
  # Later versions of xsimd ask for CD as well, which every machine with F has.
  set(avx512cd)
  if(xsimd_VERSION VERSION_GREATER_EQUAL 9)
    set(avx512cd -mavx512cd)
  endif()
  # gcc 12 warns of its own _mm512_undefined_ps (its bug 105593).
  tessera_isa(avx512 "${kernel_units}" -mavx512f ${avx512cd} -mavx512dq -mavx512bw -mavx512vl -mavx2 -mfma -mprefer-vector-width=512
    $<$<CXX_COMPILER_ID:GNU>:-Wno-uninitialized> $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
endif()
