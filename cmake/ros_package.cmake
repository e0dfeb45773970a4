# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
# The catkin package: messages, services, what other packages find. Only where catkin and roscpp are; everything else builds
# without them. Before any target: what catkin puts on a whole folder (definitions, include paths, output folders) is
# taken off again and given to the nodes alone, so that the core is compiled alike with and without ROS.
# ROS's Python modules belong to the distribution's interpreter; a pyenv or conda that comes first in PATH lacks them.
find_program(PYTHON_EXECUTABLE python3 PATHS /usr/bin NO_DEFAULT_PATH)
set(Python3_EXECUTABLE ${PYTHON_EXECUTABLE})
# What catkin installs at the root of a prefix, as setup.bash, it puts at an absolute place: that of CMAKE_INSTALL_PREFIX now,
# whatever `cmake --install --prefix` says later. A package that is built by itself gives it a relative one.
if("${CMAKE_SOURCE_DIR}" STREQUAL "${PROJECT_SOURCE_DIR}" AND NOT "${CMAKE_INSTALL_PREFIX}" STREQUAL "/usr")
  set(CMAKE_INSTALL_PREFIX .)  # beside the cached one, which is untouched
endif()
find_package(catkin QUIET)
unset(CMAKE_INSTALL_PREFIX)
find_package(roscpp QUIET)
if(NOT catkin_FOUND OR NOT roscpp_FOUND)
  message(STATUS "catkin or roscpp not found: the ROS nodes are left out")
  return()
endif()
set(VISCERA_ROS_DEPENDS diagnostic_msgs diagnostic_updater geometry_msgs image_transport roscpp roslib sensor_msgs std_msgs
    std_srvs tf2 tf2_msgs tf2_ros visualization_msgs)
find_package(catkin REQUIRED COMPONENTS message_generation ${VISCERA_ROS_DEPENDS})

add_message_files(FILES Metrics.msg Needles.msg Samples.msg StylusState.msg SurfaceTopology.msg SurfaceTopologyChange.msg SurfaceVertices.msg
                  TaskState.msg Sutures.msg Tick.msg)
add_service_files(FILES FileCommand.srv LoadScene.srv SetOverlays.srv SetToolMode.srv StartTask.srv Step.srv TieSuture.srv)
generate_messages(DEPENDENCIES geometry_msgs std_msgs)
set(EIGEN3_INCLUDE_DIRS ${EIGEN3_INCLUDE_DIR})
# What the nodes use besides is not asked of users of the library or the messages.
catkin_package(INCLUDE_DIRS include LIBRARIES viscera_core CATKIN_DEPENDS geometry_msgs message_runtime std_msgs
               DEPENDS EIGEN3 CFG_EXTRAS viscera-extras.cmake)

# rosrun looks for no node below <package>/build, and our package is the whole repository: the devel space names it in
# another way, so that nodes in build/devel are not taken for leftovers of a build.
if(EXISTS ${CATKIN_DEVEL_PREFIX}/.catkin)
  file(READ ${CATKIN_DEVEL_PREFIX}/.catkin source_spaces)
  if(source_spaces STREQUAL PROJECT_SOURCE_DIR)
    file(WRITE ${CATKIN_DEVEL_PREFIX}/.catkin "${PROJECT_SOURCE_DIR}/.")
  endif()
endif()

get_directory_property(VISCERA_ROS_DEFINITIONS COMPILE_DEFINITIONS)
set_directory_properties(PROPERTIES COMPILE_DEFINITIONS "" INCLUDE_DIRECTORIES "")
set(VISCERA_NODE_FOLDER ${CMAKE_RUNTIME_OUTPUT_DIRECTORY})
unset(CMAKE_RUNTIME_OUTPUT_DIRECTORY)
unset(CMAKE_LIBRARY_OUTPUT_DIRECTORY)
unset(CMAKE_ARCHIVE_OUTPUT_DIRECTORY)
set(VISCERA_WITH_ROS ON)
