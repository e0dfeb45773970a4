# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
# The library for other programs, libviscera_core: the folders' libraries in one, without devices and the
# float64 reference, with the headers of include/.
# `find_package(viscera)` finds it as viscera::core, in plain CMake and in a catkin workspace alike.
set(empty ${PROJECT_BINARY_DIR}/library.cpp)
if(NOT EXISTS ${empty})
  file(WRITE ${empty} "// Made by cmake/library.cmake: all of the library comes from those of the folders.\n")
endif()
add_library(viscera_core SHARED ${empty})
# A minor version may add members to public structs, such as keys of a scene: its binary interface is another, its sources fit.
set_target_properties(viscera_core PROPERTIES EXPORT_NAME core VERSION ${PROJECT_VERSION}
                                              SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
# What is compiled into it of other libraries, such as templates of the standard library, stays inside.
set(map ${PROJECT_SOURCE_DIR}/cmake/viscera_core.map)
target_link_options(viscera_core PRIVATE -Wl,--version-script=${map})
set_target_properties(viscera_core PROPERTIES LINK_DEPENDS ${map})
target_link_libraries(
  viscera_core
  PRIVATE -Wl,--whole-archive viscera_session viscera_calibration viscera_render viscera_surface viscera_solver
          viscera_tools viscera_haptics viscera_model viscera_gpu viscera_math -Wl,--no-whole-archive
  INTERFACE Eigen3::Eigen)
target_compile_features(viscera_core INTERFACE cxx_std_17)
target_include_directories(viscera_core INTERFACE $<INSTALL_INTERFACE:include>)

# The package for plain CMake: `cmake --install build --component library`. In a build with ROS the ordinary installation has
# catkin's package instead, whose configuration includes viscera-extras.cmake: the two must not be in one prefix.
set(excluded "")
if(VISCERA_WITH_ROS)
  set(excluded EXCLUDE_FROM_ALL)
  set_target_properties(viscera_core PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${CATKIN_DEVEL_PREFIX}/lib)
  install(TARGETS viscera_core LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION} COMPONENT ros)
  install(DIRECTORY include/viscera DESTINATION ${CATKIN_GLOBAL_INCLUDE_DESTINATION} COMPONENT ros)
endif()
# Shipped scenes by their names: of what is installed, and of a build those of its sources (src/math/shipped_files.cpp).
install(DIRECTORY config/scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/viscera/config COMPONENT library ${excluded})
foreach(place ${PROJECT_BINARY_DIR} ${CATKIN_DEVEL_PREFIX})
  file(WRITE ${place}/share/viscera/config_folder.txt "${PROJECT_SOURCE_DIR}/config\n")
endforeach()
include(CMakePackageConfigHelpers)
set(folder ${CMAKE_INSTALL_LIBDIR}/cmake/viscera)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/viscera-config-version.cmake COMPATIBILITY SameMajorVersion)
install(TARGETS viscera_core EXPORT viscera LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT library ${excluded})
install(EXPORT viscera NAMESPACE viscera:: FILE viscera-targets.cmake DESTINATION ${folder} COMPONENT library ${excluded})
install(DIRECTORY include/viscera DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" COMPONENT library ${excluded})
#catkin_lint: ignore_once missing_file
install(FILES cmake/viscera-config.cmake ${PROJECT_BINARY_DIR}/viscera-config-version.cmake DESTINATION ${folder}
        COMPONENT library ${excluded})
