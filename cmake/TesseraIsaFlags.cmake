# The units that hold one instruction set each, for the processor that is built for, and what finds out at run time which
# of them the machine can run: tessera_isa_units. Their flags stand here and nowhere else. Optimised in every
# configuration, so that small inline functions don't stay behind as symbols that the linker could merge into the
# baseline; less under the sanitizers, whose checks make the compiler work for minutes at -O3.
set(kernel_flags -O3 -fno-trapping-math -fno-exceptions)
if(TESSERA_SANITIZE)
  list(TRANSFORM kernel_flags REPLACE -O3 -O1)
endif()
get_filename_component(kernel_folder ${CMAKE_CURRENT_LIST_DIR}/../engine/src/kernel ABSOLUTE)

# tessera_isa_unit(FILE flags...)
macro(tessera_isa_unit file)
  list(APPEND tessera_isa_units ${kernel_folder}/${file})
  set_source_files_properties(${kernel_folder}/${file} PROPERTIES COMPILE_OPTIONS "${kernel_flags};${ARGN}")
endmacro()

if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(aarch64|arm64)$")
  set(tessera_isa_units ${kernel_folder}/machine_aarch64.cpp)
  tessera_isa_unit(isa_neon64.cpp)
else()
  set(tessera_isa_units ${kernel_folder}/machine_x86.cpp)
  tessera_isa_unit(isa_sse2.cpp -msse2)
  tessera_isa_unit(isa_avx2_fma.cpp -mavx2 -mfma)
  # gcc 12 warns of its own _mm512_undefined_ps (its bug 105593).
  tessera_isa_unit(isa_avx512.cpp -mavx512f -mavx512dq -mavx512bw -mavx512vl -mavx2 -mfma -mprefer-vector-width=512
    $<$<CXX_COMPILER_ID:GNU>:-Wno-uninitialized> $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
endif()
