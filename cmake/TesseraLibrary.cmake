# Makes the libraries from the objects of the floors.

include(CheckLinkerFlag)
configure_file(${CMAKE_CURRENT_LIST_DIR}/tessera.map.in ${PROJECT_BINARY_DIR}/tessera.map @ONLY)
set(tessera_exports ${PROJECT_BINARY_DIR}/tessera.map)
set(tessera_exports_flag "LINKER:--version-script=${tessera_exports}")
check_linker_flag(CXX "${tessera_exports_flag}" TESSERA_LINKER_READS_VERSION_SCRIPTS)

# tessera_shared_settings(TARGET): the properties of a shared library of Tessera.
# - Its name ends in the major and minor version, because these change with the interface.
# - It exports the public interface with a version, and nothing else.
# - It finds the other libraries of Tessera in its own folder.
function(tessera_shared_settings target)
  set_target_properties(${target} PROPERTIES INSTALL_RPATH "$ORIGIN"
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  if(TESSERA_LINKER_READS_VERSION_SCRIPTS)
    # The linker drops code that no export reaches.
    target_link_options(${target} PRIVATE "${tessera_exports_flag}" LINKER:--gc-sections)
    set_target_properties(${target} PROPERTIES LINK_DEPENDS ${tessera_exports})
  endif()
endfunction()

# tessera_library(NAME OBJECTS ... [ON libraries] PUBLIC ... PRIVATE ...)
#
# Makes the target tessera, or tessera_NAME_library, with two names:
# - tessera::NAME for users. BUILD_SHARED_LIBS says whether it is static or shared. It links Tessera's libraries ON.
# - tessera_internal::NAME for the project's own programs, which use internal functions too: the same library if that is
#   static, otherwise a static one of the same objects.
function(tessera_library name)
  cmake_parse_arguments(LIBRARY "" "" "ON;OBJECTS;PUBLIC;PRIVATE" ${ARGN})
  set(target tessera)
  if(NOT name STREQUAL "tessera")
    set(target tessera_${name}_library)
  endif()
  add_library(${target} ${LIBRARY_OBJECTS})
  add_library(tessera::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  get_target_property(type ${target} TYPE)
  if(type STREQUAL "SHARED_LIBRARY")
    tessera_shared_settings(${target})
    add_library(${target}_internal STATIC EXCLUDE_FROM_ALL ${LIBRARY_OBJECTS})
    add_library(tessera_internal::${name} ALIAS ${target}_internal)
    set(twins ${target} ${target}_internal)
  else()
    add_library(tessera_internal::${name} ALIAS ${target})
    set(twins ${target})
  endif()
  foreach(twin IN LISTS twins)
    if(NOT name STREQUAL "tessera")
      string(REPLACE "_library" "" output ${twin})
      set_target_properties(${twin} PROPERTIES OUTPUT_NAME ${output})
    endif()
    target_link_libraries(${twin} PUBLIC ${LIBRARY_PUBLIC} PRIVATE ${LIBRARY_PRIVATE} $<BUILD_INTERFACE:tessera_compile>)
    foreach(below IN LISTS LIBRARY_ON)
      if(twin MATCHES "_internal$")
        set(below ${below}_internal)
      endif()
      target_link_libraries(${twin} PUBLIC ${below})
    endforeach()
  endforeach()
endfunction()

# tessera_c_library(): libtessera_c, for C and for languages that call C, as tessera::c. It is always shared, holds all of
# Tessera that it uses, and exports the functions of tessera_c.h alone, with the version TSR_0.
function(tessera_c_library)
  set(exports ${PROJECT_SOURCE_DIR}/cmake/tessera_c.map)
  add_library(tessera_c_library SHARED $<TARGET_OBJECTS:tessera_c>)
  add_library(tessera::c ALIAS tessera_c_library)
  set_target_properties(tessera_c_library PROPERTIES OUTPUT_NAME tessera_c EXPORT_NAME c INSTALL_RPATH "$ORIGIN"
    VERSION 0.${PROJECT_VERSION} SOVERSION 0 LINK_DEPENDS ${exports})
  target_link_libraries(tessera_c_library PRIVATE tessera_internal::io tessera_compile)
  if(TESSERA_BUILD_RAY)
    target_link_libraries(tessera_c_library PRIVATE tessera_internal::ray)
  endif()
  target_link_options(tessera_c_library PRIVATE "LINKER:--version-script=${exports}" LINKER:--gc-sections)
  target_include_directories(tessera_c_library INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/engine/include>)
endfunction()

# tessera_uses_cad_reader(TARGET): a program of the tests or the benchmarks that reads CAD files, where they can be read.
function(tessera_uses_cad_reader target)
  if(TESSERA_HAS_CAD_READER)
    target_sources(${target} PRIVATE ${PROJECT_SOURCE_DIR}/tests/support/cad_reader.cpp)
    target_compile_definitions(${target} PRIVATE TESSERA_HAS_CAD_READER
      TESSERA_CAD_READER_FILE="$<TARGET_FILE:tessera_cad_reader>")
    add_dependencies(${target} tessera_cad_reader)
  endif()
endfunction()
