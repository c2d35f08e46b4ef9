# Builds and runs tests/consumer as its users would:
#   cmake -D WAY=package      against the package that the build in BUILD installs into a fresh prefix
#   cmake -D WAY=subdirectory with the sources in SOURCE as a subdirectory
# with -D SOURCE= BUILD= WORK= READELF= GENERATOR= COMPILER= [CONFIG= PYTHON= PKG_CONFIG=] -P consumer.cmake. WORK is emptied first.

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# build_consumer(FOLDER definitions...): configures and builds WORK/FOLDER.
function(build_consumer folder)
  run(${CMAKE_COMMAND} -S ${SOURCE}/tests/consumer -B ${WORK}/${folder} -G ${GENERATOR}
    -D CMAKE_CXX_COMPILER=${COMPILER} ${ARGN})
  run(${CMAKE_COMMAND} --build ${WORK}/${folder} --target ${TARGETS})
endfunction()

# needs_embree(FILE yes|no): whether the program asks the loader for Embree must be as stated.
function(needs_embree file expected)
  execute_process(COMMAND ${READELF} -d ${file} OUTPUT_VARIABLE dynamic COMMAND_ERROR_IS_FATAL ANY)
  set(found no)
  if(dynamic MATCHES "NEEDED[^\n]*libembree")
    set(found yes)
  endif()
  if(NOT found STREQUAL expected)
    message(FATAL_ERROR "${file} needs Embree: ${found}; expected ${expected}")
  endif()
endfunction()

# run_in(FOLDER PROGRAM): each program works where it was built.
function(run_in folder program)
  execute_process(COMMAND ${WORK}/${folder}/${program} WORKING_DIRECTORY ${WORK}/${folder} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})

if(WAY STREQUAL "package")
  set(prefix ${WORK}/prefix)
  set(config)
  if(CONFIG)
    set(config --config ${CONFIG})
  endif()
  run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix} ${config})
  # The package must be of use on another machine: nothing in it names this tree or its private targets.
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

  set(package -D CMAKE_PREFIX_PATH=${prefix} -D CMAKE_BUILD_TYPE=Release)
  set(TARGETS all)
  build_consumer(rays ${package})
  run_in(rays consumer)
  run_in(rays tessellate_only)
  needs_embree(${WORK}/rays/consumer yes)
  needs_embree(${WORK}/rays/tessellate_only no)
  build_consumer(no_embree ${package} -D CONSUMER_RAYS=OFF)
  run_in(no_embree tessellate_only)

  if(PKG_CONFIG)
    file(GLOB_RECURSE found ${prefix}/*/tessera.pc)
    get_filename_component(folder ${found} DIRECTORY)
    set(ENV{PKG_CONFIG_PATH} ${folder})
    get_filename_component(libraries ${folder} DIRECTORY)
    set(ENV{LD_LIBRARY_PATH} ${libraries})
    foreach(program tessellate_only main)
      set(modules tessera)
      if(program STREQUAL "main")
        set(modules tessera-ray tessera-io)
      endif()
      execute_process(COMMAND ${PKG_CONFIG} --cflags --libs ${modules} OUTPUT_VARIABLE flags
        OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
      separate_arguments(flags UNIX_COMMAND "${flags}")
      file(MAKE_DIRECTORY ${WORK}/pkg_config)
      run(${COMPILER} -std=c++20 ${SOURCE}/tests/consumer/${program}.cpp -o ${WORK}/pkg_config/${program} ${flags})
      run_in(pkg_config ${program})
    endforeach()
  else()
    message(STATUS "pkg-config is not there: tessera.pc is not tried")
  endif()
  if(PYTHON)
    foreach(guide tessellation-backend ray-hits tracking-speed)
      run(${PYTHON} ${SOURCE}/tests/house/guides.py ${SOURCE}/docs/${guide}.md ${WORK}/${guide} ${prefix} ${CMAKE_COMMAND}
        ${GENERATOR} ${COMPILER})
    endforeach()
  else()
    message(STATUS "Python is not there: the guides are not followed")
  endif()
elseif(WAY STREQUAL "subdirectory")
  # No build type: Tessera must not choose one for a project that left it open. It also compiles fastest.
  set(TARGETS consumer tessellate_only)
  build_consumer(subdirectory -D TESSERA_SOURCE=${SOURCE} -D CMAKE_BUILD_TYPE=)
  run_in(subdirectory consumer)
  run_in(subdirectory tessellate_only)
  needs_embree(${WORK}/subdirectory/tessellate_only no)
else()
  message(FATAL_ERROR "WAY is '${WAY}'; there are package and subdirectory")
endif()
