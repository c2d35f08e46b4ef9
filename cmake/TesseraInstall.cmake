# What `cmake --install` lays down: the libraries, the public headers, the command line, and the package that
# find_package(tessera) reads, and pkg-config. Each component has its own file of targets, so that the core never looks for Embree.
# COMPONENT names the Debian package (TesseraPackages.cmake) that holds a file; without it that is libtessera-dev.

include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
include(TesseraPkgConfig)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/tessera)
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME libtessera-dev)

# tessera_install_component(NAME TARGET): the library TARGET as tessera::NAME, in tessera_NAME_targets.cmake.
function(tessera_install_component name target)
  install(TARGETS ${target} EXPORT tessera_${name}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT libtessera NAMELINK_COMPONENT libtessera-dev
    RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR}
    INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(EXPORT tessera_${name} FILE tessera_${name}_targets.cmake NAMESPACE tessera:: DESTINATION ${package_dir})
endfunction()

# tessera_install_python(): the package for Debian's Python, which looks in lib/pythonX.Y of /usr/local and in lib/python3
# of /usr. It finds the C library beside it. pip and importlib.metadata list it by its dist-info, which has
# no RECORD, so that pip does not uninstall it. Without Debian's Python nothing is installed.
function(tessera_install_python)
  if(NOT DEFINED TESSERA_PYTHON_DIR AND EXISTS /usr/bin/python3)
    execute_process(COMMAND /usr/bin/python3 -c "import sys; print('%d.%d' % sys.version_info[:2])"
      OUTPUT_VARIABLE python OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
    if(CMAKE_INSTALL_PREFIX STREQUAL "/usr")
      set(python 3)
    endif()
    set(TESSERA_PYTHON_DIR lib/python${python}/dist-packages CACHE STRING
      "Where the package for Python is installed; empty: not at all")
  endif()
  if(TESSERA_PYTHON_DIR)
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/tools/python/tessera DESTINATION ${TESSERA_PYTHON_DIR} COMPONENT python3-tessera
      FILES_MATCHING PATTERN "*.py" PATTERN "py.typed" PATTERN "view.html" PATTERN "live.js" PATTERN "__pycache__" EXCLUDE)
    # The package that live views need, where it is built (target tessera_npm of the preset "wasm").
    install(DIRECTORY ${TESSERA_NPM_FOLDER}/ DESTINATION ${TESSERA_PYTHON_DIR}/tessera/npm COMPONENT python3-tessera OPTIONAL
      FILES_MATCHING PATTERN "*.js" PATTERN "package.json" PATTERN "LICENSE" PATTERN "tessera.wasm"
      PATTERN "three" EXCLUDE PATTERN "worker" EXCLUDE PATTERN "node_modules" EXCLUDE)
    set(info ${PROJECT_BINARY_DIR}/python/tessera-${PROJECT_VERSION}.dist-info)
    string(JOIN "\n" metadata "Metadata-Version: 2.1" "Name: tessera" "Version: ${PROJECT_VERSION}"
      "Summary: ${PROJECT_DESCRIPTION}" "Requires-Python: >=3.9" "Requires-Dist: numpy>=1.22" "")
    file(WRITE ${info}/METADATA "${metadata}")
    file(WRITE ${info}/INSTALLER "cmake\n")
    install(DIRECTORY ${info} DESTINATION ${TESSERA_PYTHON_DIR} COMPONENT python3-tessera)
  endif()
endfunction()

# The page and the package, which the targets tessera_web and tessera_npm of the preset "wasm" make: looked for at the
# installation.
set(TESSERA_WEB_FOLDER ${PROJECT_SOURCE_DIR}/build/wasm/web CACHE STRING
  "The page of tessera view, which is installed if it is there")
set(TESSERA_NPM_FOLDER ${PROJECT_SOURCE_DIR}/build/wasm/npm CACHE STRING
  "tessera.wasm with its scripts, which is installed with the package for Python if it is there")

# The headers of a component that is not built stay out.
set(left_out)
tessera_install_component(core tessera)
tessera_install_pkg_config(tessera tessera "${PROJECT_DESCRIPTION}" REQUIRES tbb)
if(TESSERA_BUILD_RAY)
  tessera_install_component(ray tessera_ray_library)
  set(embree_library)
  if(TESSERA_HAS_EMBREE)
    set(embree_library LIBS -lembree${tessera_embree_major})
  else()
    list(APPEND left_out PATTERN "ray_embree.h" EXCLUDE)
  endif()
  tessera_install_pkg_config(tessera-ray tessera_ray_library "Ray queries on Tessera's surfaces" ON tessera
    ${embree_library} CFLAGS -DTESSERA_EMBREE_MAJOR=${tessera_embree_major})
else()
  list(APPEND left_out PATTERN "ray_*.h" EXCLUDE)
endif()
if(TESSERA_BUILD_IO)
  tessera_install_component(io tessera_io_library)
  set(zlib_package)
  if(TESSERA_HAS_ZLIB)
    set(zlib_package zlib)
  endif()
  set(meshopt_library)
  if(TESSERA_HAS_MESHOPT)
    set(meshopt_library -lmeshoptimizer)  # its package has no file for pkg-config
  endif()
  tessera_install_pkg_config(tessera-io tessera_io_library "Tessera's readers of surfaces and writers of meshes" ON tessera
    REQUIRES muparser ${zlib_package} LIBS ${meshopt_library})
else()
  list(APPEND left_out PATTERN "io.h" EXCLUDE PATTERN "cad.h" EXCLUDE PATTERN "surface_file.h" EXCLUDE)
endif()
if(TESSERA_BUILD_PARTS)
  tessera_install_component(parts tessera_parts_library)
  tessera_install_pkg_config(tessera-parts tessera_parts_library "Models in parts that do not fit into memory or on one machine"
    ON tessera-ray tessera-io)
else()
  list(APPEND left_out PATTERN "part_*.h" EXCLUDE PATTERN "transport.h" EXCLUDE)
endif()
if(TESSERA_HAS_MPI)
  tessera_install_component(mpi tessera_mpi_library)
  tessera_install_pkg_config(tessera-mpi tessera_mpi_library "Parts of models as the ranks of MPI" ON tessera-parts
    REQUIRES mpi-c CFLAGS -DOMPI_SKIP_MPICXX)
else()
  list(APPEND left_out PATTERN "mpi.h" EXCLUDE)
endif()
if(TESSERA_HAS_OCCT AND TESSERA_BUILD_OCCT)  # else the reader alone stands on it
  tessera_install_component(occt tessera_occt_library)
  tessera_install_pkg_config(tessera-occt tessera_occt_library "Tessera's models of OpenCASCADE's shapes" ON tessera
    LIBS "-L${OpenCASCADE_LIBRARY_DIR} -lTKBRep -lTKGeomBase -lTKG3d -lTKG2d -lTKMath -lTKernel"
    CFLAGS "-I${OpenCASCADE_INCLUDE_DIR}")
else()
  list(APPEND left_out PATTERN "occt*.h" EXCLUDE)
endif()
if(TESSERA_BUILD_C)
  tessera_install_component(c tessera_c_library)
  tessera_install_pkg_config(tessera-c tessera_c_library "Tessera for C and for languages that call C")
  tessera_install_python()
else()
  list(APPEND left_out PATTERN "tessera_c.h" EXCLUDE PATTERN "tessera_c_files.h" EXCLUDE
    PATTERN "tessera_c_shapes.h" EXCLUDE PATTERN "tessera_c_queries.h" EXCLUDE)
endif()
if(TESSERA_HAS_CAD_READER)
  install(TARGETS tessera_cad_reader RUNTIME DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/tessera COMPONENT tessera-cad-reader)
endif()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/engine/include/tessera DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  FILES_MATCHING PATTERN "*.h" ${left_out})
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME tessera)
# Every installed text may name these, and no other page.
set(doc_dir ${CMAKE_INSTALL_DATAROOTDIR}/doc/tessera)
install(FILES ${PROJECT_SOURCE_DIR}/tools/models/FORMAT.md ${PROJECT_SOURCE_DIR}/engine/docs/meshes.md
  ${PROJECT_SOURCE_DIR}/tools/models/gallery.jpg DESTINATION ${doc_dir})
if(TESSERA_BUILD_TOOLS)
  install(FILES ${PROJECT_SOURCE_DIR}/tools/tessera/JSON.md DESTINATION ${doc_dir})
  install(TARGETS tessera_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  install(DIRECTORY ${TESSERA_WEB_FOLDER}/ DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/tessera/web OPTIONAL)
  if(TESSERA_HAS_MPI)
    install(TARGETS tessera_mpi_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  endif()
  if(TARGET tessera_cli_texts)
    set(texts ${PROJECT_BINARY_DIR}/tools/texts)
    install(FILES ${texts}/tessera.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
    install(FILES ${texts}/tessera.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME tessera)
    set(zsh_folder site-functions)
    if(CMAKE_INSTALL_PREFIX STREQUAL "/usr" AND EXISTS /etc/debian_version)
      set(zsh_folder vendor-completions)
    endif()
    install(FILES ${texts}/tessera.zsh DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/${zsh_folder} RENAME _tessera)
    install(FILES ${texts}/tessera.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
  endif()
endif()
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME libtessera-dev)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/licenses/tessera)

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/tesseraConfig.cmake.in
  ${PROJECT_BINARY_DIR}/tesseraConfig.cmake INSTALL_DESTINATION ${package_dir})
# Before 1.0 a minor version may change the interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/tesseraConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/tesseraConfig.cmake ${PROJECT_BINARY_DIR}/tesseraConfigVersion.cmake
  DESTINATION ${package_dir})
