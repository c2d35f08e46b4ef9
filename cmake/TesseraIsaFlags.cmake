# Flags of the units that hold one instruction set each. They stand here and nowhere else. Optimised in every
# configuration, so that small inline functions don't stay behind as symbols that the linker could merge into the baseline;
# less under the sanitizers, whose checks make the compiler work for minutes at -O3.
set(kernel_flags -O3 -fno-trapping-math -fno-exceptions)
if(TESSERA_SANITIZE)
  list(TRANSFORM kernel_flags REPLACE -O3 -O1)
endif()
set_source_files_properties(src/kernel/isa_sse2.cpp PROPERTIES COMPILE_OPTIONS "${kernel_flags};-msse2")
set_source_files_properties(src/kernel/isa_avx2_fma.cpp PROPERTIES COMPILE_OPTIONS "${kernel_flags};-mavx2;-mfma")
# gcc 12 warns of its own _mm512_undefined_ps (its bug 105593).
set_source_files_properties(src/kernel/isa_avx512.cpp PROPERTIES COMPILE_OPTIONS
  "${kernel_flags};-mavx512f;-mavx512dq;-mavx512bw;-mavx512vl;-mavx2;-mfma;-mprefer-vector-width=512;$<$<CXX_COMPILER_ID:GNU>:-Wno-uninitialized;-Wno-maybe-uninitialized>")
