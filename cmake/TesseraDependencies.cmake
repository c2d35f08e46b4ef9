# Where each dependency comes from. All are packages of Debian 12; tools/setup.sh installs them.
#   oneTBB            libtbb-dev 2021.8           the core: threads (engine/src/parallel alone includes it)
#   xsimd             libxsimd-dev 8.1            the core: SIMD batches (engine/src/kernel alone; headers only)
#   Embree            libembree-dev 3.13          tessera::ray (engine/src/ray alone, and ray_embree.h); 4 will do; optional
#   OpenCASCADE       libocct-modeling-data-dev 7.6  tessera::occt (engine/src/occt and io_occt alone, and occt.h); optional
#                     libocct-data-exchange-dev 7.6  tessera-cad-reader (engine/src/io_occt alone); optional
#   Open MPI          libopenmpi-dev 4.1, openmpi-bin  tessera::mpi (engine/src/mpi alone, and mpi.h), tessera_mpi; optional
#   CLI11             libcli11-dev 2.1            the command line
#   nlohmann-json     nlohmann-json3-dev 3.11     tessera::io: models (headers only, within engine/src/io);
#                                               the command line: --json; tests: values of peers
#   muParser          libmuparser-dev 2.3         tessera::io: expressions in models (engine/src/io alone)
#   zlib              zlib1g-dev 1.2              tessera::io: files packed by gzip (engine/src/io alone); optional
#   meshoptimizer     libmeshoptimizer-dev 0.18   tessera::io: packed glTF (engine/src/io/mesh alone); optional
#   libpng            libpng-dev 1.6              the command line and the benchmarks: pictures
#   OpenEXR           libopenexr-dev 3.1          the command line: float pictures; tests: its reader
#   GoogleTest        libgtest-dev 1.12           tests (and libgmock-dev: its matchers); bench: two reports
#   tinygltf          libtinygltf-dev 2.7         tests: a reader of glTF
#   assimp            libassimp-dev 5.2           tests: another reader of glTF; skipped without
#   Google Benchmark  libbenchmark-dev 1.7        benchmarks
#   valgrind          valgrind 3.19               tests: instructions counted (tools/perf count), skipped without
#   Universal Ctags   universal-ctags 5.9        tests: names that editors find; skipped without
#   Python            python3 3.11                tools/perf and its tests, its standard library alone; skipped without
#   PyYAML            python3-yaml 6.0            the test of the recipe in tools/performance/template; skipped without
#   mypy              mypy 1.0                    the test of the types of the package for Python; skipped without
#   Chromium          chromium                    the tests of views of notebooks and of the page; skipped without
#   xdg-open          xdg-utils 1.1               tessera view, when it runs: opens the browser; without it the address is printed
#   librsvg           librsvg2-bin 2.54           tools/perf report: plots as PNG; left out without
#   a cross compiler  g++-aarch64-linux-gnu 12.2  the test of the NEON kernels, with qemu-user 7.2; skipped without
#   ImageMagick       imagemagick 6.9             tools/gallery.sh alone: pictures on one sheet
#   Doxygen           doxygen 1.9                 the target docs, and its test; skipped without
#   clang-format      clang-format-14             tools/lint.sh, and its test; skipped without. clang-tidy: tools/lint.sh --tidy
# What Tessera is compared with, where TESSERA_BUILD_PEERS is ON (tools/peers.sh installs it). bench/peers alone looks for
# these, and builds what it finds:
#   OpenCASCADE       libocct-modeling-data-dev, libocct-modeling-algorithms-dev 7.6
#   OpenSubdiv        libosd-dev 3.5
#   SISL              libsisl-dev 4.6             AGPL: linked by one program of its own, which links nothing of Tessera

# The library of threads that the core links for its loops.
set(tessera_threads)
if(TESSERA_USE_TBB)
  find_package(TBB 2021 REQUIRED)
  set(tessera_threads TBB::tbb)
  find_package(Threads REQUIRED)
endif()
if(TESSERA_IS_WASM)
  include(TesseraWasm)
else()
  # Its version file takes no other major version for compatible.
  find_package(xsimd REQUIRED)
  if(xsimd_VERSION VERSION_LESS 8)
    message(FATAL_ERROR "xsimd ${xsimd_VERSION} is found, in ${xsimd_DIR}; version 8 or later is needed")
  endif()
endif()
# Whether tessera::ray has Embree's trees beside its own, what it links for that, and the version, 0 without.
set(TESSERA_HAS_EMBREE OFF)
set(tessera_embree)
set(tessera_embree_major 0)
if(TESSERA_BUILD_RAY AND TESSERA_USE_EMBREE)
  if(NOT TESSERA_EMBREE_MAJOR MATCHES "^(|3|4)$")
    message(FATAL_ERROR "TESSERA_EMBREE_MAJOR is '${TESSERA_EMBREE_MAJOR}'; it must be 3, 4 or empty")
  elseif(TESSERA_EMBREE_MAJOR)
    find_package(embree ${TESSERA_EMBREE_MAJOR} QUIET)
  else()
    find_package(embree 3 QUIET)
    if(NOT embree_FOUND)
      find_package(embree 4 QUIET)
    endif()
  endif()
  if(embree_FOUND)
    set(TESSERA_HAS_EMBREE ON)
    set(tessera_embree embree)
    set(tessera_embree_major ${embree_VERSION_MAJOR})
  elseif(TESSERA_USE_EMBREE STREQUAL "AUTO" AND NOT TESSERA_EMBREE_MAJOR)
    message(STATUS "Rays are traced without Embree, and ray_embree.h is left out: it is not found (libembree-dev)")
  else()
    message(FATAL_ERROR "Embree ${TESSERA_EMBREE_MAJOR} is not found. On Debian it is libembree-dev. "
      "TESSERA_USE_EMBREE=OFF builds tessera::ray without it.")
  endif()
endif()
if(TESSERA_BUILD_IO)
  find_package(nlohmann_json 3 REQUIRED)
  if(NOT TARGET muparser::muparser)  # built from its source for WebAssembly
    find_package(muparser 2 REQUIRED)
  endif()
endif()
# Whether tessera::io unpacks files of gzip, and what it links for that.
set(TESSERA_HAS_ZLIB OFF)
set(tessera_zlib)
if(TESSERA_BUILD_IO)
  find_package(ZLIB QUIET)
  if(ZLIB_FOUND)
    set(TESSERA_HAS_ZLIB ON)
    set(tessera_zlib ZLIB::ZLIB)
  else()
    message(STATUS "Packed files (.gz) are not read: zlib is not found (zlib1g-dev)")
  endif()
endif()
# Whether tessera::io packs and unpacks glTF, and what it links for that.
set(TESSERA_HAS_MESHOPT OFF)
set(tessera_meshopt)
if(TESSERA_BUILD_IO AND NOT TESSERA_IS_WASM)
  find_package(meshoptimizer QUIET)
  if(meshoptimizer_FOUND)
    set(TESSERA_HAS_MESHOPT ON)
    set(tessera_meshopt meshoptimizer::meshoptimizer)
  else()
    message(STATUS "Packed glTF is neither read nor written: meshoptimizer is not found (libmeshoptimizer-dev)")
  endif()
endif()
# Whether tessera::occt is built, and tessera-cad-reader, which stands on it.
set(TESSERA_HAS_OCCT OFF)
set(TESSERA_HAS_CAD_READER OFF)
if(TESSERA_BUILD_OCCT OR (TESSERA_BUILD_IO AND TESSERA_BUILD_CAD_READER))
  include(TesseraOpenCascade)
  set(TESSERA_HAS_OCCT ${tessera_OpenCASCADE_FOUND})
  if(NOT TESSERA_HAS_OCCT AND TESSERA_BUILD_OCCT STREQUAL "AUTO")
    message(STATUS "tessera::occt is left out: OpenCASCADE is not found (tools/setup.sh --for cad)")
  elseif(NOT TESSERA_HAS_OCCT AND TESSERA_BUILD_OCCT)
    message(FATAL_ERROR "TESSERA_BUILD_OCCT is ON, but OpenCASCADE 7.5 or later is not found. "
      "On Debian it is libocct-modeling-data-dev.")
  endif()
endif()
if(TESSERA_BUILD_IO AND TESSERA_BUILD_CAD_READER)
  set(TESSERA_HAS_CAD_READER ${tessera_OpenCASCADE_exchange_FOUND})
  if(NOT TESSERA_HAS_CAD_READER AND TESSERA_BUILD_CAD_READER STREQUAL "AUTO")
    message(STATUS "tessera-cad-reader (IGES, BREP, STEP on request) is left out: OpenCASCADE is not found "
      "(tools/cad_reader.sh installs it)")
  elseif(NOT TESSERA_HAS_CAD_READER)
    message(FATAL_ERROR "TESSERA_BUILD_CAD_READER is ON, but OpenCASCADE 7.5 or later with its data exchange is not found. "
      "On Debian it is libocct-data-exchange-dev.")
  endif()
endif()
# Whether tessera::mpi is built.
set(TESSERA_HAS_MPI OFF)
if(TESSERA_BUILD_PARTS AND TESSERA_BUILD_MPI)
  set(MPI_CXX_SKIP_MPICXX ON)  # no interface for C++ before MPI 3
  find_package(MPI 3 QUIET COMPONENTS CXX)
  set(TESSERA_HAS_MPI ${MPI_CXX_FOUND})
  if(NOT TESSERA_HAS_MPI AND TESSERA_BUILD_MPI STREQUAL "AUTO")
    message(STATUS "tessera::mpi and tessera_mpi are left out: MPI is not found (tools/setup.sh --for mpi)")
  elseif(NOT TESSERA_HAS_MPI)
    message(FATAL_ERROR "TESSERA_BUILD_MPI is ON, but MPI 3 or later is not found. On Debian it is libopenmpi-dev.")
  endif()
endif()
if(TESSERA_BUILD_TOOLS)
  find_package(CLI11 2 REQUIRED)
  find_package(nlohmann_json 3 REQUIRED)
  # Debian's Imath says at each configuration that files of its Python package are missing, which nobody needs.
  set(kept_log_level "${CMAKE_MESSAGE_LOG_LEVEL}")
  set(CMAKE_MESSAGE_LOG_LEVEL NOTICE)
  find_package(OpenEXR 3 CONFIG REQUIRED)
  set(CMAKE_MESSAGE_LOG_LEVEL "${kept_log_level}")
endif()
if(TESSERA_BUILD_TOOLS OR TESSERA_BUILD_BENCH)
  find_package(PNG REQUIRED)
endif()
if(TESSERA_BUILD_TESTS OR TESSERA_BUILD_BENCH)
  find_package(GTest REQUIRED)
endif()
if(TESSERA_BUILD_TESTS)
  find_package(nlohmann_json 3 REQUIRED)
  if(TESSERA_BUILD_IO)
    find_package(TinyGLTF CONFIG REQUIRED)
  endif()
endif()
if(TESSERA_BUILD_BENCH)
  find_package(benchmark REQUIRED)
endif()
