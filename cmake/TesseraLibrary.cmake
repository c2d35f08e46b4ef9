# The libraries that the floors make up.

include(CheckLinkerFlag)
configure_file(${CMAKE_CURRENT_LIST_DIR}/tessera.map.in ${PROJECT_BINARY_DIR}/tessera.map @ONLY)
set(tessera_exports ${PROJECT_BINARY_DIR}/tessera.map)
set(tessera_exports_flag "LINKER:--version-script=${tessera_exports}")
check_linker_flag(CXX "${tessera_exports_flag}" TESSERA_LINKER_READS_VERSION_SCRIPTS)

# tessera_shared_settings(TARGET): what a shared library of Tessera has beside its code: a versioned name, which changes
# where the interface may; its exports, versioned too; and its place beside the others.
function(tessera_shared_settings target)
  set_target_properties(${target} PROPERTIES INSTALL_RPATH "$ORIGIN"
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  if(TESSERA_LINKER_READS_VERSION_SCRIPTS)
    # What is not exported and not called by what is, goes.
    target_link_options(${target} PRIVATE "${tessera_exports_flag}" LINKER:--gc-sections)
    set_target_properties(${target} PROPERTIES LINK_DEPENDS ${tessera_exports})
  endif()
endfunction()

# tessera_library(NAME OBJECTS ... [ON library] PUBLIC ... PRIVATE ...): tessera::NAME, static or shared as BUILD_SHARED_LIBS
# says, on the library ON of Tessera. And tessera_internal::NAME, for the project's own programs, which use more than what is
# public: the same target, or its static twin if it is shared. The targets: tessera, or tessera_NAME_library.
function(tessera_library name)
  cmake_parse_arguments(LIBRARY "" "ON" "OBJECTS;PUBLIC;PRIVATE" ${ARGN})
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
    if(LIBRARY_ON AND twin MATCHES "_internal$")
      target_link_libraries(${twin} PUBLIC ${LIBRARY_ON}_internal)
    elseif(LIBRARY_ON)
      target_link_libraries(${twin} PUBLIC ${LIBRARY_ON})
    endif()
  endforeach()
endfunction()
