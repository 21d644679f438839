# SPDX-License-Identifier: GPL-3.0-or-later
# OpenFOAM of the .com line (v1912 and later), found in one of two ways:
#   environment  a sourced OpenFOAM: $WM_PROJECT_DIR and $FOAM_LIBBIN, with lnInclude folders below $FOAM_SRC
#   debian       packages openfoam and libopenfoam, which have no headers: scripts/get-openfoam-headers.sh provides them
# A set WM_PROJECT_DIR alone says nothing: Debian's programs need it as well.
#
# In   COMPONENTS             libraries: meshTools finiteVolume ...
#      OPENFOAM_HEADERS_DIR   where Debian's headers are kept (default: a cache outside the source, see the script)
# Out  OpenFOAM_FOUND, OpenFOAM_API (for instance 1912), OpenFOAM_MODE, OpenFOAM_ETC_PROJECT_DIR (WM_PROJECT_DIR at run
#      time), targets OpenFOAM::OpenFOAM and OpenFOAM::<component>
include(FindPackageHandleStandardArgs)
set(OPENFOAM_HEADERS_DIR "" CACHE PATH "headers of Debian's OpenFOAM; empty: a folder in the user's cache")

# where they are
set(_of_src "$ENV{FOAM_SRC}")
if(NOT _of_src)
  set(_of_src "$ENV{WM_PROJECT_DIR}/src")
endif()
set(_of_label 32)
set(_of_precision DP)
if(EXISTS "${_of_src}/OpenFOAM/lnInclude/argList.H" AND DEFINED ENV{FOAM_LIBBIN})
  set(OpenFOAM_MODE environment)
  set(OpenFOAM_ETC_PROJECT_DIR "$ENV{WM_PROJECT_DIR}")
  set(_of_meta "$ENV{WM_PROJECT_DIR}/META-INFO/api-info")
  set(_of_lib "$ENV{FOAM_LIBBIN}")
  set(_of_pstream "$ENV{FOAM_LIBBIN}/$ENV{FOAM_MPI}")
  if(DEFINED ENV{WM_LABEL_SIZE})
    set(_of_label "$ENV{WM_LABEL_SIZE}")
  endif()
  if(DEFINED ENV{WM_PRECISION_OPTION})
    set(_of_precision "$ENV{WM_PRECISION_OPTION}")
  endif()
elseif(EXISTS /usr/lib/libOpenFOAM.so)
  set(OpenFOAM_MODE debian)
  set(OpenFOAM_ETC_PROJECT_DIR /usr/share/openfoam)
  set(_of_lib /usr/lib)
  set(_of_pstream /usr/lib) # libPstream.so here is the Open MPI one; never /usr/lib/dummy
  execute_process(
    COMMAND bash "${CMAKE_CURRENT_LIST_DIR}/../scripts/get-openfoam-headers.sh" ${OPENFOAM_HEADERS_DIR}
    RESULT_VARIABLE _of_result OUTPUT_VARIABLE _of_output ERROR_VARIABLE _of_error OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(NOT _of_result EQUAL 0)
    message(FATAL_ERROR "no headers for the installed OpenFOAM:\n${_of_error}")
  endif()
  string(REGEX REPLACE ".*\n" "" _of_headers "${_of_output}")
  set(_of_src "${_of_headers}/src")
  set(_of_meta "${_of_headers}/META-INFO/api-info")
endif()

set(OpenFOAM_API "")
if(OpenFOAM_MODE AND EXISTS "${_of_meta}")
  file(STRINGS "${_of_meta}" OpenFOAM_API REGEX "^api=")
  string(REPLACE "api=" "" OpenFOAM_API "${OpenFOAM_API}")
endif()

# folders below src/ that are not called as their library, and what a library's headers include
set(_of_folder_extrudeModel mesh/extrudeModel)
set(_of_folder_lagrangian lagrangian/basic)
set(_of_folder_fieldFunctionObjects functionObjects/field)
set(_of_folder_forces functionObjects/forces)
set(_of_needs_surfMesh fileFormats)
set(_of_needs_meshTools fileFormats surfMesh)
set(_of_needs_finiteVolume meshTools)
set(_of_needs_dynamicMesh finiteVolume extrudeModel)
set(_of_needs_sampling finiteVolume dynamicMesh lagrangian)
set(_of_needs_forces finiteVolume)
set(_of_needs_fieldFunctionObjects finiteVolume)

function(_of_add_library name folder file)
  add_library(OpenFOAM::${name} SHARED IMPORTED)
  # the libraries carry no SONAME: without NO_SONAME the full path would be written into the executable
  set_target_properties(OpenFOAM::${name} PROPERTIES IMPORTED_LOCATION "${file}" IMPORTED_NO_SONAME TRUE)
  if(EXISTS "${_of_src}/${folder}/lnInclude")
    target_include_directories(OpenFOAM::${name} SYSTEM INTERFACE "${_of_src}/${folder}/lnInclude")
  endif()
endfunction()

function(_of_add_component name)
  if(TARGET OpenFOAM::${name})
    return()
  endif()
  if(NOT EXISTS "${_of_lib}/lib${name}.so")
    message(FATAL_ERROR "OpenFOAM component ${name}: no lib${name}.so in ${_of_lib}")
  endif()
  set(folder ${name})
  if(_of_folder_${name})
    set(folder ${_of_folder_${name}})
  endif()
  _of_add_library(${name} ${folder} "${_of_lib}/lib${name}.so")
  target_link_libraries(OpenFOAM::${name} INTERFACE OpenFOAM::OpenFOAM)
  foreach(need IN LISTS _of_needs_${name})
    _of_add_component(${need})
    target_link_libraries(OpenFOAM::${name} INTERFACE OpenFOAM::${need})
  endforeach()
endfunction()

find_package_handle_standard_args(OpenFOAM
  REQUIRED_VARS OpenFOAM_MODE OpenFOAM_API VERSION_VAR OpenFOAM_API
  REASON_FAILURE_MESSAGE "source an OpenFOAM of the .com line, or run scripts/installDependencies.sh")

if(OpenFOAM_FOUND AND NOT TARGET OpenFOAM::OpenFOAM)
  _of_add_library(Pstream Pstream "${_of_pstream}/libPstream.so")
  _of_add_library(OpenFOAM OpenFOAM "${_of_lib}/libOpenFOAM.so")
  target_include_directories(OpenFOAM::OpenFOAM SYSTEM INTERFACE "${_of_src}/OSspecific/POSIX/lnInclude")
  target_link_libraries(OpenFOAM::OpenFOAM INTERFACE OpenFOAM::Pstream ${CMAKE_DL_LIBS} m)
  target_compile_definitions(OpenFOAM::OpenFOAM INTERFACE
    OPENFOAM=${OpenFOAM_API} WM_${_of_precision} WM_LABEL_SIZE=${_of_label} NoRepository)
  # -Walloc-size-larger-than crosses SYSTEM when ListI.H is inlined
  target_compile_options(OpenFOAM::OpenFOAM INTERFACE
    $<$<COMPILE_LANGUAGE:CXX>:-ftemplate-depth=256 -Wno-alloc-size-larger-than>)
  if(OpenFOAM_MODE STREQUAL environment)
    # RPATH, not RUNPATH: LD_LIBRARY_PATH must not lead to another OpenFOAM. Open MPI's mpirun, called by its full path, puts its own /usr/lib first, where Debian's may lie.
    target_link_options(OpenFOAM::OpenFOAM INTERFACE "LINKER:-rpath-link,${_of_lib}:${_of_pstream}" "LINKER:--disable-new-dtags")
  endif()
  foreach(component IN LISTS OpenFOAM_FIND_COMPONENTS)
    _of_add_component(${component})
  endforeach()
  message(STATUS "OpenFOAM v${OpenFOAM_API} (${OpenFOAM_MODE}), labels of ${_of_label} bits, ${_of_precision}, headers ${_of_src}")
endif()
