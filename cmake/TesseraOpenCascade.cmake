# Finds OpenCASCADE (7.5 or later; its own version file lets no other patch version pass) and sets
# tessera_OpenCASCADE_FOUND, and tessera_OpenCASCADE_exchange_FOUND if its readers of files are there too. What its package
# adds to the compile definitions of the folder is taken back: only the targets are wanted.

get_directory_property(_tessera_definitions COMPILE_DEFINITIONS)
set(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL ON)  # for programs of the project that adds this one, which link tessera::occt
find_package(OpenCASCADE QUIET)
unset(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL)
set_directory_properties(PROPERTIES COMPILE_DEFINITIONS "${_tessera_definitions}")
unset(_tessera_definitions)

set(tessera_OpenCASCADE_FOUND FALSE)
set(tessera_OpenCASCADE_exchange_FOUND FALSE)
if(OpenCASCADE_FOUND AND TARGET TKBRep)
  if("${OpenCASCADE_MAJOR_VERSION}.${OpenCASCADE_MINOR_VERSION}" VERSION_GREATER_EQUAL 7.5)
    set(tessera_OpenCASCADE_FOUND TRUE)
    if(TARGET TKSTEP AND TARGET TKIGES)
      set(tessera_OpenCASCADE_exchange_FOUND TRUE)
    endif()
  endif()
endif()
