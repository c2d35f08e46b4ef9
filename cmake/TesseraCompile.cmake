# Compiler settings, and the function that declares one floor of the house.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
if(NOT TESSERA_IS_WASM)  # a module is never moved
  set(CMAKE_POSITION_INDEPENDENT_CODE ON)
endif()
# A project that adds this one keeps its own choice, no choice included.
if(PROJECT_IS_TOP_LEVEL AND NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
elseif(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES AND NOT CMAKE_CXX_FLAGS MATCHES "-O")
  message(WARNING "CMAKE_BUILD_TYPE is empty, so Tessera is compiled without optimisation, but for its kernels: planning, "
    "reading and rays take several times as long. Set -D CMAKE_BUILD_TYPE=Release, or -O2 in CMAKE_CXX_FLAGS.")
endif()

# Carried by every target of this project, and by none of its users.
add_library(tessera_compile INTERFACE)
target_compile_options(tessera_compile INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wno-sign-conversion -Wold-style-cast -Wnon-virtual-dtor
  # Tests set this property: files of one unit would warn of each other's names. clang's warning counts names of files
  # beside it in a unit, and captures of structured bindings.
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<NOT:$<BOOL:$<TARGET_PROPERTY:TESSERA_MAY_SHADOW>>>>:-Wshadow>
  # clang 19 warns of std::stable_sort of libstdc++ 12.
  $<$<CXX_COMPILER_ID:Clang>:-Wno-deprecated-declarations>
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

# tessera_floor(NAME [LEVEL level] SOURCES files... BELOW floors...)
#
# Makes the target tessera_NAME of files in engine/src/NAME. They include the public headers, their own folder and the
# floors below, all as <folder>/<file>; tests/house checks every #include.
#
# - LEVEL: how Release optimises the floor, -O3 unless told.
# - With CMAKE_UNITY_BUILD, each folder is compiled as one unit, because parsing the same headers takes most of the time.
#   So names in anonymous namespaces differ within a folder.
function(tessera_floor name)
  get_filename_component(engine ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/../engine ABSOLUTE)
  cmake_parse_arguments(FLOOR "" "LEVEL" "SOURCES;BELOW" ${ARGN})
  if(TESSERA_IS_WASM)  # a page loads all of it first: code for speed only where most of the time goes
    set(FLOOR_LEVEL -Oz)
    if(name MATCHES "^(block|eval|plane|tess|ray)$")
      set(FLOOR_LEVEL -O2)
    endif()
  endif()
  add_library(tessera_${name} OBJECT ${FLOOR_SOURCES})
  target_compile_options(tessera_${name} PRIVATE $<$<CONFIG:Release>:-ffunction-sections> $<$<CONFIG:Release>:${FLOOR_LEVEL}>)
  target_include_directories(tessera_${name} PRIVATE ${engine}/include ${engine}/src)
  target_link_libraries(tessera_${name} PRIVATE tessera_compile)
  # What a public header declares is exported (it says so), and nothing else.
  set_target_properties(tessera_${name} PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  tessera_unit_per_folder(tessera_${name})
  foreach(below IN LISTS FLOOR_BELOW)
    if(TARGET tessera_${below})  # the floor c does without rays
      add_dependencies(tessera_${name} tessera_${below})
    endif()
  endforeach()
endfunction()

# tessera_unit_per_folder(TARGET): with CMAKE_UNITY_BUILD, the files of a folder are compiled as one unit.
function(tessera_unit_per_folder target)
  get_target_property(files ${target} SOURCES)
  foreach(file IN LISTS files)
    get_filename_component(folder ${file} DIRECTORY)
    get_filename_component(folder ${folder} NAME)
    set_source_files_properties(${file} PROPERTIES UNITY_GROUP ${folder})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD_MODE GROUP)
  # gcc takes the files of a unit for headers, in which classes must not hold what anonymous namespaces define. It also
  # inlines less in large units: without the parameter readers take up to a tenth more instructions.
  target_compile_options(${target} PRIVATE $<$<AND:$<CXX_COMPILER_ID:GNU>,$<BOOL:$<TARGET_PROPERTY:UNITY_BUILD>>>:
    -Wno-subobject-linkage;--param=large-unit-insns=1000000>)
endfunction()
