# Compiler settings, and the function that declares one floor of the house.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
# A project that adds this one keeps its own choice, no choice included.
if(PROJECT_IS_TOP_LEVEL AND NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

# Carried by every target of this project, and by none of its users.
add_library(tessera_compile INTERFACE)
target_compile_options(tessera_compile INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wold-style-cast -Wnon-virtual-dtor
  # gcc 12 warns wrongly of string + string (its bug 105651).
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
  # Results must not depend on what the compiler fuses, and NaN and infinity keep their meaning.
  -ffp-contract=off -fno-math-errno)
if(TESSERA_WARNINGS_AS_ERRORS)
  target_compile_options(tessera_compile INTERFACE -Werror)
endif()
if(TESSERA_SANITIZE)
  target_compile_options(tessera_compile INTERFACE -fsanitize=${TESSERA_SANITIZE} -fno-omit-frame-pointer
    -fno-sanitize-recover=all)
  target_link_options(tessera_compile INTERFACE -fsanitize=${TESSERA_SANITIZE})
endif()

# tessera_floor(NAME SOURCES... [BALANCED sources...] [SIZE_OPTIMIZED sources...] BELOW floors...)
#
# Makes the target tessera_NAME of sources in engine/src/NAME. They include the public headers, their own folder and the
# floors below, all as <folder>/<file>; tests/house checks every #include.
#
# Optimisation in Release: SOURCES at -O3; BALANCED sources, which hand batches to kernels, at -O2; SIZE_OPTIMIZED
# sources, which run once per surface, at -Os. Move a source to a smaller level only if that does not change the
# instructions that tools/perf count reports.
function(tessera_floor name)
  get_filename_component(engine ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/../engine ABSOLUTE)
  cmake_parse_arguments(FLOOR "" "" "SOURCES;BALANCED;SIZE_OPTIMIZED;BELOW" ${ARGN})
  add_library(tessera_${name} OBJECT ${FLOOR_SOURCES} ${FLOOR_BALANCED} ${FLOOR_SIZE_OPTIMIZED})
  target_compile_options(tessera_${name} PRIVATE $<$<CONFIG:Release>:-ffunction-sections>)
  set_source_files_properties(${FLOOR_BALANCED} PROPERTIES COMPILE_OPTIONS $<$<CONFIG:Release>:-O2>)
  set_source_files_properties(${FLOOR_SIZE_OPTIMIZED} PROPERTIES COMPILE_OPTIONS $<$<CONFIG:Release>:-Os>)
  target_include_directories(tessera_${name} PRIVATE ${engine}/include ${engine}/src)
  target_link_libraries(tessera_${name} PRIVATE tessera_compile)
  # What a public header declares is exported (it says so), and nothing else.
  set_target_properties(tessera_${name} PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  foreach(below IN LISTS FLOOR_BELOW)
    add_dependencies(tessera_${name} tessera_${below})
  endforeach()
endfunction()
