# Writes one file per component for pkg-config: tessera.pc, tessera-ray.pc, tessera-io.pc, tessera-parts.pc, tessera-mpi.pc,
# tessera-occt.pc, tessera-c.pc. Users of a static library link its dependencies too, so its file lists them; a shared
# library links them itself.

# tessera_install_pkg_config(NAME TARGET DESCRIPTION [ON names...] [REQUIRES names...] [LIBS "-l..."] [CFLAGS "-D..."]):
# REQUIRES and LIBS are what the library itself needs.
function(tessera_install_pkg_config pc_name target pc_description)
  cmake_parse_arguments(NEEDS "" "LIBS;CFLAGS" "ON;REQUIRES" ${ARGN})
  list(TRANSFORM NEEDS_ON APPEND " = ${PROJECT_VERSION}")
  get_target_property(type ${target} TYPE)
  set(pc_requires ${NEEDS_ON})
  set(pc_libs)
  set(pc_cflags ${NEEDS_CFLAGS})
  if(type STREQUAL "SHARED_LIBRARY")
    set(pc_requires_private ${NEEDS_REQUIRES})
    set(pc_libs_private ${NEEDS_LIBS})
  else()
    set(pc_requires_private)
    set(pc_libs_private)
    list(APPEND pc_requires ${NEEDS_REQUIRES})
    set(pc_libs ${NEEDS_LIBS})
  endif()
  list(JOIN pc_requires ", " pc_requires)
  list(JOIN pc_requires_private ", " pc_requires_private)
  string(REPLACE "-" "_" pc_library ${pc_name})
  file(RELATIVE_PATH pc_up /usr/${CMAKE_INSTALL_LIBDIR}/pkgconfig /usr)
  string(REGEX REPLACE "/$" "" pc_up ${pc_up})
  configure_file(${PROJECT_SOURCE_DIR}/cmake/tessera.pc.in ${PROJECT_BINARY_DIR}/${pc_name}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/${pc_name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endfunction()
