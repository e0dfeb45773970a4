# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
# ROS 1 nodes, messages and launch files: only where catkin and roscpp are found. Everything else builds without them.
# ROS's Python modules belong to the distribution's interpreter; a pyenv or conda that comes first in PATH lacks them.
find_program(PYTHON_EXECUTABLE python3 PATHS /usr/bin NO_DEFAULT_PATH)
set(Python3_EXECUTABLE ${PYTHON_EXECUTABLE})
find_package(catkin QUIET)
find_package(roscpp QUIET)
if(NOT catkin_FOUND OR NOT roscpp_FOUND)
  message(STATUS "catkin or roscpp not found: the ROS nodes are left out")
  return()
endif()
set(VISCERA_ROS_DEPENDS diagnostic_updater geometry_msgs image_transport roscpp roslib sensor_msgs std_msgs std_srvs
    tf2_ros visualization_msgs)
find_package(catkin REQUIRED COMPONENTS message_generation ${VISCERA_ROS_DEPENDS})

add_message_files(FILES SurfaceTopology.msg SurfaceVertices.msg)
add_service_files(FILES Step.srv)
generate_messages(DEPENDENCIES std_msgs)
catkin_package(CATKIN_DEPENDS message_runtime ${VISCERA_ROS_DEPENDS})

# src/nodes/<name>_node.cpp is the main of the node <name>; the rest is a library that the tests link too.
file(GLOB node_mains CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/nodes/*_node.cpp)
file(GLOB node_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/nodes/*.cpp)
list(REMOVE_ITEM node_sources ${node_mains})
add_library(viscera_nodes STATIC ${node_sources})
add_dependencies(viscera_nodes ${PROJECT_NAME}_generate_messages_cpp ${catkin_EXPORTED_TARGETS})
target_include_directories(viscera_nodes PUBLIC ${PROJECT_SOURCE_DIR}/src)
target_include_directories(viscera_nodes SYSTEM PUBLIC ${catkin_INCLUDE_DIRS}
                           ${CATKIN_DEVEL_PREFIX}/${CATKIN_GLOBAL_INCLUDE_DESTINATION})
target_compile_options(viscera_nodes PRIVATE ${VISCERA_CXX_FLAGS})
target_link_libraries(viscera_nodes PUBLIC viscera_session ${catkin_LIBRARIES})

set(VISCERA_NODES "")
foreach(main ${node_mains})
  get_filename_component(stem ${main} NAME_WE)
  string(REGEX REPLACE "_node$" "" node ${stem})
  add_executable(${node} ${main})
  target_compile_options(${node} PRIVATE ${VISCERA_CXX_FLAGS})
  target_link_libraries(${node} PRIVATE viscera_nodes)
  list(APPEND VISCERA_NODES ${node})
endforeach()
unset(CMAKE_RUNTIME_OUTPUT_DIRECTORY)  # catkin's, for nodes: tests stay in the build folder
