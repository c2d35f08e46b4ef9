# Builds and runs tests/consumer as its users would:
#   cmake -D WAY=package      against the package that the build in BUILD installs into a fresh prefix
#   cmake -D WAY=subdirectory with the sources in SOURCE as a subdirectory: shared libraries, which are then installed
#                             and found as a package too, static ones of the same objects, and the core alone
# with -D SOURCE= BUILD= WORK= READELF= GENERATOR= COMPILER= [CONFIG= PYTHON= PKG_CONFIG=] -P consumer.cmake. WORK is
# emptied first.

cmake_minimum_required(VERSION 3.25)

set(programs consumer embree_scene parts tessellate_only)

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# build_consumer(FOLDER definitions...): configures and builds WORK/FOLDER.
function(build_consumer folder)
  run(${CMAKE_COMMAND} -S ${SOURCE}/tests/consumer -B ${WORK}/${folder} -G ${GENERATOR}
    -D CMAKE_CXX_COMPILER=${COMPILER} ${ARGN})
  run(${CMAKE_COMMAND} --build ${WORK}/${folder} --target ${TARGETS})
endfunction()

# needs(FILE LIBRARY yes|no): whether the program asks the loader for the library must be as stated.
function(needs file library expected)
  execute_process(COMMAND ${READELF} -d ${file} OUTPUT_VARIABLE dynamic COMMAND_ERROR_IS_FATAL ANY)
  set(found no)
  if(dynamic MATCHES "NEEDED[^\n]*\\[${library}")
    set(found yes)
  endif()
  if(NOT found STREQUAL expected)
    message(FATAL_ERROR "${file} needs ${library}: ${found}; expected ${expected}")
  endif()
endfunction()

# run_in(FOLDER PROGRAM): each program works where it was built.
function(run_in folder program)
  execute_process(COMMAND ${WORK}/${folder}/${program} WORKING_DIRECTORY ${WORK}/${folder} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# run_programs(FOLDER static|shared): runs all of them, and checks which libraries they ask the loader for. A program
# that only tessellates does not need Embree; neither do programs on shared libraries, of which only the one of rays
# needs it.
function(run_programs folder kind)
  foreach(program IN LISTS programs)
    run_in(${folder} ${program})
  endforeach()
  set(static yes)
  set(shared no)
  if(kind STREQUAL "shared")
    set(static no)
    set(shared yes)
  endif()
  set(version "\\.so\\.[0-9]+\\.[0-9]+\\]")
  set(place ${WORK}/${folder})
  needs(${place}/consumer libembree ${static})
  needs(${place}/consumer "libtessera_ray${version}" ${shared})
  needs(${place}/embree_scene libembree yes)
  needs(${place}/parts "libtessera_parts${version}" ${shared})
  needs(${place}/tessellate_only libembree no)
  needs(${place}/tessellate_only libTK no)
  needs(${place}/consumer libTK no)
  if(EXISTS ${place}/shapes)
    run_in(${folder} shapes)
    needs(${place}/shapes libTKBRep yes)
    needs(${place}/shapes "libtessera_occt${version}" ${shared})
  endif()
  needs(${place}/parts libmpi no)
  if(EXISTS ${place}/ranks)
    needs(${place}/ranks libmpi yes)
    needs(${place}/ranks "libtessera_mpi${version}" ${shared})
  endif()
  needs(${place}/tessellate_only "libtessera${version}" ${shared})
  needs(${place}/tessellate_only libtessera_ray no)
endfunction()

# check_texts(PREFIX): checks that each page that an installed header or text names is installed, and no source is named.
function(check_texts prefix)
  file(GLOB_RECURSE texts ${prefix}/include/*.h ${prefix}/share/*)
  list(FILTER texts EXCLUDE REGEX "\\.jpg$|/share/tessera/web/")
  foreach(text IN LISTS texts)
    file(READ ${text} content)
    string(REGEX MATCHALL "[A-Za-z_./-]+\\.md" pages "${content}")
    foreach(page IN LISTS pages)
      get_filename_component(own ${text} DIRECTORY)
      if(NOT EXISTS ${prefix}/${page} AND NOT EXISTS ${own}/${page})
        message(FATAL_ERROR "${text} names ${page}, which is not installed")
      endif()
    endforeach()
    if(content MATCHES "[^a-z](engine|tools|tests|bench)/[a-z_]+[a-z_/.]*")
      message(FATAL_ERROR "${text} names ${CMAKE_MATCH_0}, which is not installed")
    endif()
  endforeach()
endfunction()

# check_package(PREFIX): checks that the installed package is usable on another machine and names neither this tree nor
# its private targets; builds the programs with it, with CMake and without.
function(check_package prefix)
  check_texts(${prefix})
  file(GLOB_RECURSE files ${prefix}/*.cmake ${prefix}/*.h)
  foreach(file IN LISTS files)
    file(READ ${file} text)
    foreach(private ${SOURCE} ${BUILD} ${WORK} tessera_compile)
      string(FIND "${text}" "${private}" place)
      if(NOT place EQUAL -1)
        message(FATAL_ERROR "${file} names ${private}")
      endif()
    endforeach()
  endforeach()

  set(kind static)
  file(GLOB_RECURSE libraries ${prefix}/libtessera_ray.so)
  if(libraries)
    set(kind shared)
  endif()
  set(TARGETS all)
  build_consumer(rays -D CMAKE_PREFIX_PATH=${prefix} -D CMAKE_BUILD_TYPE=Release)
  run_programs(rays ${kind})
  build_consumer(no_embree -D CMAKE_PREFIX_PATH=${prefix} -D CMAKE_BUILD_TYPE=Release -D CONSUMER_RAYS=OFF)
  run_in(no_embree tessellate_only)
  build_speed(${prefix})
  if(PKG_CONFIG)
    build_by_pkg_config(${prefix})
  else()
    message(STATUS "pkg-config is not there: tessera.pc is not tried")
  endif()
endfunction()

# build_speed(PREFIX): the template of programs that tools/perf tracks, as the project that it is copied to.
function(build_speed prefix)
  run(${CMAKE_COMMAND} -S ${SOURCE}/tools/performance/template -B ${WORK}/speed -G ${GENERATOR}
    -D CMAKE_CXX_COMPILER=${COMPILER} -D CMAKE_PREFIX_PATH=${prefix})
  run(${CMAKE_COMMAND} --build ${WORK}/speed)
  run_in(speed speed)
endfunction()

# check_cad_reader(PREFIX): the installed command line starts the installed reader, if one was built, and does not itself
# load OpenCASCADE.
function(check_cad_reader prefix)
  needs(${prefix}/bin/tessera libTK no)
  needs(${prefix}/bin/tessera libmpi no)
  if(EXISTS ${BUILD}/tools/tessera-cad-reader)
    needs(${prefix}/libexec/tessera/tessera-cad-reader libTKSTEP yes)
    file(WRITE ${WORK}/part.step "no part")
    unset(ENV{TESSERA_CAD_READER})
    execute_process(COMMAND ${prefix}/bin/tessera info ${WORK}/part.step --step-reader opencascade
      ERROR_VARIABLE message)
    if(NOT message MATCHES "part.step: OpenCASCADE cannot read it as STEP")
      message(FATAL_ERROR "the installed tessera does not find the installed reader: ${message}")
    endif()
  else()
    message(STATUS "tessera-cad-reader was not built: its installation is not tried")
  endif()
endfunction()

# check_python(PREFIX): the installed package for Python finds the installed library, and the reader of CAD files.
function(check_python prefix)
  file(GLOB package ${prefix}/lib/python3*/dist-packages)
  execute_process(COMMAND /usr/bin/python3 -c "import numpy" RESULT_VARIABLE status OUTPUT_QUIET ERROR_QUIET)
  if(NOT package OR NOT status EQUAL 0)
    message(STATUS "the package for Python is not installed, or NumPy is not there: it is not tried")
    return()
  endif()
  string(CONCAT code "import sys, tessera as ts\n"
    "print(ts.__file__, ts.read(sys.argv[1]).patches().tessellate(1e-3).is_certified, "
    "len(ts.read(sys.argv[2], step_reader=sys.argv[3])) > 0)\n")
  set(models ${SOURCE}/tools/models)
  set(step_reader tessera)
  if(EXISTS ${BUILD}/tools/tessera-cad-reader)
    set(step_reader opencascade)
  endif()
  execute_process(COMMAND ${CMAKE_COMMAND} -E env --unset=TESSERA_C_LIBRARY --unset=TESSERA_CAD_READER --unset=LD_LIBRARY_PATH
      PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=${package} /usr/bin/python3 -c ${code} ${models}/goblet.json
      ${models}/bearing_block.step ${step_reader}
    WORKING_DIRECTORY ${WORK} OUTPUT_VARIABLE found OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  if(NOT found STREQUAL "${package}/tessera/__init__.py True True")
    message(FATAL_ERROR "the installed package for Python says: ${found}")
  endif()
endfunction()

function(build_by_pkg_config prefix)
  file(GLOB_RECURSE found ${prefix}/tessera.pc)
  get_filename_component(folder ${found} DIRECTORY)
  set(ENV{PKG_CONFIG_PATH} ${folder})
  get_filename_component(libraries ${folder} DIRECTORY)
  set(ENV{LD_LIBRARY_PATH} ${libraries})
  file(MAKE_DIRECTORY ${WORK}/pkg_config)
  foreach(program tessellate_only main parts)
    set(modules tessera)
    if(program STREQUAL "main")
      set(modules tessera-ray tessera-io)
    elseif(program STREQUAL "parts")
      set(modules tessera-parts)
    endif()
    execute_process(COMMAND ${PKG_CONFIG} --cflags --libs ${modules} OUTPUT_VARIABLE flags
      OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
    separate_arguments(flags UNIX_COMMAND "${flags}")
    run(${COMPILER} -std=c++20 ${SOURCE}/tests/consumer/${program}.cpp -o ${WORK}/pkg_config/${program} ${flags})
    run_in(pkg_config ${program})
  endforeach()
  if(EXISTS ${folder}/tessera-c.pc)
    execute_process(COMMAND ${PKG_CONFIG} --cflags --libs tessera-c OUTPUT_VARIABLE flags
      OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
    separate_arguments(flags UNIX_COMMAND "${flags}")
    run(cc -std=c99 ${SOURCE}/tests/c/program.c ${SOURCE}/tests/c/layout.c ${SOURCE}/tests/c/layout_of_queries.c
      -o ${WORK}/pkg_config/program ${flags} -lm)
    run_in(pkg_config program)
  endif()
  unset(ENV{LD_LIBRARY_PATH})
endfunction()

file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
set(prefix ${WORK}/prefix)

if(WAY STREQUAL "package")
  set(config)
  if(CONFIG)
    set(config --config ${CONFIG})
  endif()
  run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix} ${config})
  check_package(${prefix})
  check_cad_reader(${prefix})
  check_python(${prefix})
  if(PYTHON)
    set(guides README engine/docs/tessellation-backend engine/docs/ray-hits engine/docs/renderer engine/docs/tracking-speed
      engine/docs/c engine/docs/queries)
    # Its program also uses OpenCASCADE's modelling algorithms, which come with what the reader needs.
    file(GLOB_RECURSE occt ${prefix}/tessera_occt_targets.cmake)
    if(occt AND EXISTS ${BUILD}/tools/tessera-cad-reader)
      list(APPEND guides engine/docs/opencascade)
    else()
      message(STATUS "tessera::occt or tessera-cad-reader was not built: the guide for OpenCASCADE is not followed")
    endif()
    foreach(guide IN LISTS guides)
      get_filename_component(folder ${guide} NAME)
      set(shell)
      if(guide STREQUAL "README")
        set(shell --shell ${BUILD})
      endif()
      run(${PYTHON} ${SOURCE}/tests/house/guides.py ${SOURCE}/${guide}.md ${WORK}/${folder} ${prefix} ${CMAKE_COMMAND}
        ${GENERATOR} ${COMPILER} ${shell})
    endforeach()
  else()
    message(STATUS "Python is not there: the guides are not followed")
  endif()
elseif(WAY STREQUAL "subdirectory")
  # No build type: Tessera must not choose one for a project that left it open. It also compiles fastest: most of the
  # time is that of the kernels, which it optimises no more than necessary.
  set(options -D TESSERA_SOURCE=${SOURCE} -D CMAKE_BUILD_TYPE= -D TESSERA_INSTALL=ON -D TESSERA_KERNEL_LEVEL=-O1
    -D CMAKE_UNITY_BUILD=ON)
  set(TARGETS ${programs})
  if(EXISTS ${BUILD}/tools/tessera-cad-reader)
    list(APPEND TARGETS shapes)
  endif()
  build_consumer(subdirectory ${options} -D BUILD_SHARED_LIBS=ON)
  run_programs(subdirectory shared)
  run(${CMAKE_COMMAND} --install ${WORK}/subdirectory --prefix ${prefix})
  # The programs must not look for libraries where these were built.
  file(RENAME ${WORK}/subdirectory ${WORK}/away)
  check_package(${prefix})
  file(RENAME ${WORK}/away ${WORK}/subdirectory)
  build_consumer(subdirectory ${options} -D BUILD_SHARED_LIBS=OFF)
  run_programs(subdirectory static)
  # The core alone, as a project gets it that sets no option. Its objects are those of the build before.
  set(TARGETS tessellate_only)
  build_consumer(subdirectory ${options} -D BUILD_SHARED_LIBS=OFF -D CONSUMER_RAYS=OFF)
  run_in(subdirectory tessellate_only)
else()
  message(FATAL_ERROR "WAY is '${WAY}'; there are package and subdirectory")
endif()
