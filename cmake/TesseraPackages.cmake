# The Debian packages that CPack makes of the components of TesseraInstall.cmake. tools/package.sh builds and packs the
# preset "package", which installs below /usr.

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_PACKAGE_CONTACT "Tessera's maintainers <root@localhost>" CACHE STRING "Maintainer of the packages")
set(CPACK_PACKAGING_INSTALL_PREFIX ${CMAKE_INSTALL_PREFIX})
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_COMPONENTS_ALL)

# The licences of Tessera and of the headers that are compiled into it.
set(copyright ${PROJECT_BINARY_DIR}/copyright)
file(READ ${PROJECT_SOURCE_DIR}/LICENSE texts)
foreach(package libxsimd-dev nlohmann-json3-dev libcli11-dev)
  if(EXISTS /usr/share/doc/${package}/copyright)
    file(READ /usr/share/doc/${package}/copyright text)
    string(APPEND texts "\n\nHeaders of ${package}:\n\n${text}")
  endif()
endforeach()
file(WRITE ${copyright} "${texts}")

# tessera_package(NAME SECTION DESCRIPTION [DEPENDS packages...] [RECOMMENDS packages...] [SUGGESTS packages...] [ALL]): the
# package NAME of the component NAME. The libraries that its programs are linked with are added to DEPENDS. ALL: it has no
# programs and serves every architecture.
macro(tessera_package name section description)
  cmake_parse_arguments(PACKAGE "ALL" "" "DEPENDS;RECOMMENDS;SUGGESTS" ${ARGN})
  string(TOUPPER CPACK_DEBIAN_${name} prefix)
  list(APPEND CPACK_COMPONENTS_ALL ${name})
  set(${prefix}_PACKAGE_NAME ${name})
  set(${prefix}_PACKAGE_SECTION ${section})
  set(${prefix}_DESCRIPTION "${description}")
  foreach(field DEPENDS RECOMMENDS SUGGESTS)
    list(JOIN PACKAGE_${field} ", " ${prefix}_PACKAGE_${field})
  endforeach()
  set(${prefix}_PACKAGE_SHLIBDEPS ON)
  if(PACKAGE_ALL)
    set(${prefix}_PACKAGE_SHLIBDEPS OFF)
    set(${prefix}_PACKAGE_ARCHITECTURE all)
  endif()
  install(FILES ${copyright} DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/${name} COMPONENT ${name})
endmacro()

set(same "libtessera (= ${PROJECT_VERSION})")
tessera_package(libtessera libs "The shared libraries.")
set(embree_package)
if(TESSERA_HAS_EMBREE)
  set(embree_package libembree-dev)
endif()
tessera_package(libtessera-dev libdevel "The headers, with files for CMake and pkg-config."
  DEPENDS ${same} libtbb-dev ${embree_package} libmuparser-dev libmeshoptimizer-dev zlib1g-dev SUGGESTS tessera)
tessera_package(tessera graphics "The command line." RECOMMENDS tessera-cad-reader SUGGESTS xdg-utils)
tessera_package(tessera-cad-reader graphics "Reads IGES and BREP files, and STEP files on request, for Tessera's programs, by OpenCASCADE.")
tessera_package(python3-tessera python "The package for Python: results as arrays of NumPy." ALL
  DEPENDS ${same} "python3 (>= 3.9)" python3-numpy SUGGESTS tessera-cad-reader)
include(CPack)
