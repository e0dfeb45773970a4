# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
# viscera_hdf5, where HDF5 is there: `viscera sweep --hdf5`. Linked statically where it can be: Debian's shared library brings thirty more along,
# of network protocols not used here.
option(VISCERA_HDF5 "viscera sweep --hdf5, where libhdf5 is there" ON)
if(VISCERA_HDF5)
  pkg_search_module(HDF5 QUIET IMPORTED_TARGET hdf5-serial hdf5)
endif()
if(VISCERA_HDF5 AND HDF5_FOUND)
  find_library(HDF5_STATIC libhdf5.a HINTS ${HDF5_LIBRARY_DIRS} NO_DEFAULT_PATH)
  find_library(SZ_STATIC libsz.a)
  find_library(AEC_STATIC libaec.a)
  add_library(viscera_hdf5 INTERFACE)
  target_compile_definitions(viscera_hdf5 INTERFACE VISCERA_HDF5)
  if(HDF5_STATIC AND SZ_STATIC AND AEC_STATIC)
    target_include_directories(viscera_hdf5 SYSTEM INTERFACE ${HDF5_INCLUDE_DIRS})
    target_link_libraries(viscera_hdf5 INTERFACE ${HDF5_STATIC} ${SZ_STATIC} ${AEC_STATIC} z ${CMAKE_DL_LIBS})
  else()
    target_link_libraries(viscera_hdf5 INTERFACE PkgConfig::HDF5)
  endif()
elseif(VISCERA_HDF5)
  message(STATUS "HDF5 not found: viscera sweep writes CSV alone")
endif()
