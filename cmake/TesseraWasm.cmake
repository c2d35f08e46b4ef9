# The build for WebAssembly (cmake/wasm32.cmake): what stands in for gaps of the C++ library, muParser, and the module.
#   clang, lld        clang-19, lld-19 19.1
#   C library         wasi-libc 0.0~git20220510
#   C++ library       libc++-19-dev-wasm32, libc++abi-19-dev-wasm32 19.1
#   compiler's        libclang-rt-19-dev-wasm32 19.1
#   fast_float        libfast-float-dev 3.9    from_chars() of doubles, which that C++ library lacks (headers only)
#   muParser          the source package muparser 2.3, because Debian has no library of it for WebAssembly
#   Node              nodejs 18 or later       the tests

set(TESSERA_MUPARSER_SOURCE ${PROJECT_SOURCE_DIR}/build/sources/muparser CACHE PATH
  "The source of muParser, where tools/setup.sh --for wasm unpacks it")
if(NOT EXISTS ${TESSERA_MUPARSER_SOURCE}/src/muParserBase.cpp)
  message(FATAL_ERROR "There is no source of muParser in ${TESSERA_MUPARSER_SOURCE}: run tools/setup.sh --for wasm, or set "
    "TESSERA_MUPARSER_SOURCE")
endif()

# Found before the C++ library's own headers, which they include.
include_directories(BEFORE SYSTEM ${PROJECT_SOURCE_DIR}/engine/wasm32/include)
file(GLOB gaps CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/engine/wasm32/*.cpp)
add_library(tessera_wasm_gaps OBJECT ${gaps})
target_link_libraries(tessera_wasm_gaps PRIVATE tessera_compile)
# clang 19 crashes over a landing pad in the unit that defines what landing pads write to.
set_target_properties(tessera_wasm_gaps PROPERTIES UNITY_BUILD OFF)

set(muparser_files muParser muParserBase muParserBytecode muParserCallback muParserError muParserTokenReader)
list(TRANSFORM muparser_files PREPEND ${TESSERA_MUPARSER_SOURCE}/src/)
list(TRANSFORM muparser_files APPEND .cpp)
add_library(muparser STATIC ${muparser_files})
add_library(muparser::muparser ALIAS muparser)
target_include_directories(muparser SYSTEM PUBLIC ${TESSERA_MUPARSER_SOURCE}/include)
target_compile_definitions(muparser PUBLIC MUPARSER_STATIC)
target_compile_options(muparser PRIVATE -w -Os)

# tessera_wasm_module(): tessera.wasm, a reactor that exports the functions of tessera_c*.h that this build has, malloc()
# and free(). It imports functions of WASI and of its host, which tools/npm/src/host.js answers.
function(tessera_wasm_module)
  file(GLOB headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/engine/include/tessera/tessera_c*.h)
  set(exports malloc free)
  foreach(header IN LISTS headers)
    file(STRINGS ${header} lines REGEX "^[a-z].*[ *]tsr_[a-z0-9_]+\\(")
    list(TRANSFORM lines REPLACE "^.*[ *](tsr_[a-z0-9_]+)\\(.*$" "\\1")
    list(APPEND exports ${lines})
  endforeach()
  list(TRANSFORM exports PREPEND LINKER:--export-if-defined=)
  add_executable(tessera_wasm $<TARGET_OBJECTS:tessera_wasm_gaps> $<TARGET_OBJECTS:tessera_c>)
  set_target_properties(tessera_wasm PROPERTIES OUTPUT_NAME tessera SUFFIX .wasm
    RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
  target_link_libraries(tessera_wasm PRIVATE tessera_internal::io tessera_compile)
  if(TESSERA_BUILD_RAY)
    target_link_libraries(tessera_wasm PRIVATE tessera_internal::ray)
  endif()
  # 2 GiB at most, so that the difference of two pointers is a ptrdiff_t. The stack lies first, so that a call too many
  # traps instead of writing over data.
  target_link_options(tessera_wasm PRIVATE -mexec-model=reactor LINKER:--gc-sections LINKER:--strip-all
    LINKER:--stack-first LINKER:-z,stack-size=4194304 LINKER:--initial-memory=16777216 LINKER:--max-memory=2147483648 ${exports})

  # The package for npm, whole in the folder npm: tools/npm with the module, and the layout of its structs.
  set(package ${PROJECT_BINARY_DIR}/npm)
  set(sources ${PROJECT_SOURCE_DIR}/tools/npm)
  find_program(NODE node)
  add_custom_target(tessera_npm DEPENDS tessera_wasm COMMENT "Making ${package}" VERBATIM
    COMMAND ${CMAKE_COMMAND} -E rm -rf ${package}
    COMMAND ${CMAKE_COMMAND} -E copy_directory ${sources} ${package}
    COMMAND ${CMAKE_COMMAND} -E copy $<TARGET_FILE:tessera_wasm> ${PROJECT_SOURCE_DIR}/LICENSE ${package}
    COMMAND ${NODE} ${sources}/layout.mjs ${PROJECT_SOURCE_DIR}/engine/include/tessera ${package}/src/layout.js)

  # The page in one folder, with that package and with three: `npm ci` in tools/web fetches it.
  set(page ${PROJECT_SOURCE_DIR}/tools/web)
  add_custom_target(tessera_web DEPENDS tessera_npm COMMENT "Making ${PROJECT_BINARY_DIR}/web" VERBATIM
    COMMAND ${CMAKE_COMMAND} -E chdir ${page} sh -c "[ -d node_modules/three ] || npm ci"
    COMMAND ${NODE} ${page}/assemble.mjs ${package} ${PROJECT_BINARY_DIR}/web)

  # The kernels alone, for tests/wasm.
  set(jobs tessera_wasm_kernel_jobs)
  add_executable(${jobs} EXCLUDE_FROM_ALL ${PROJECT_SOURCE_DIR}/tests/kernel/neon64/kernel_jobs.cpp
    $<TARGET_OBJECTS:tessera_base> $<TARGET_OBJECTS:tessera_kernel> ${tessera_isa_objects} $<TARGET_OBJECTS:tessera_wasm_gaps>)
  set_target_properties(${jobs} PROPERTIES OUTPUT_NAME kernel_jobs SUFFIX .wasm RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
  target_include_directories(${jobs} PRIVATE ${PROJECT_SOURCE_DIR}/engine/include ${PROJECT_SOURCE_DIR}/engine/src)
  target_link_libraries(${jobs} PRIVATE tessera_compile)
endfunction()
