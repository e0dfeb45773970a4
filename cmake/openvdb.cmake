# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
# Debian ships OpenVDB without a CMake config on the default path: find the library and headers themselves.
find_path(OPENVDB_INCLUDE_DIR openvdb/openvdb.h REQUIRED)
find_library(OPENVDB_LIBRARY openvdb REQUIRED)
find_library(TBB_LIBRARY tbb REQUIRED)
# Its headers use half-precision numbers from Imath (or, before OpenEXR 3, from Half) in functions that are compiled here.
find_library(IMATH_LIBRARY NAMES Imath Imath-3_1 Half)
add_library(viscera_openvdb INTERFACE)
target_include_directories(viscera_openvdb SYSTEM INTERFACE ${OPENVDB_INCLUDE_DIR})
target_link_libraries(viscera_openvdb INTERFACE ${OPENVDB_LIBRARY} ${TBB_LIBRARY})
if(IMATH_LIBRARY)
  target_link_libraries(viscera_openvdb INTERFACE ${IMATH_LIBRARY})
endif()
