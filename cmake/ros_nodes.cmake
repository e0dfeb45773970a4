# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
# The ROS nodes, of the package that ros_package.cmake made.
# src/nodes/<name>_node.cpp is the main of the node <name>; the rest is a library that the tests link too.
file(GLOB node_mains CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/nodes/*_node.cpp)
file(GLOB node_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/nodes/*.cpp)
list(REMOVE_ITEM node_sources ${node_mains})
find_package(interactive_markers QUIET)
if(NOT interactive_markers_FOUND)
  message(STATUS "interactive_markers not found: the node stylus_marker is left out")
  list(REMOVE_ITEM node_sources ${PROJECT_SOURCE_DIR}/src/nodes/stylus_marker.cpp)
  list(REMOVE_ITEM node_mains ${PROJECT_SOURCE_DIR}/src/nodes/stylus_marker_node.cpp)
endif()
add_library(viscera_nodes STATIC ${node_sources})
add_dependencies(viscera_nodes ${PROJECT_NAME}_generate_messages_cpp ${catkin_EXPORTED_TARGETS})
target_include_directories(viscera_nodes PUBLIC ${PROJECT_SOURCE_DIR}/src)
target_include_directories(viscera_nodes SYSTEM PUBLIC ${catkin_INCLUDE_DIRS} ${interactive_markers_INCLUDE_DIRS}
                           ${CATKIN_DEVEL_PREFIX}/${CATKIN_GLOBAL_INCLUDE_DESTINATION})
target_compile_options(viscera_nodes PRIVATE ${VISCERA_CXX_FLAGS})
target_compile_definitions(viscera_nodes PUBLIC ${VISCERA_ROS_DEFINITIONS})
target_link_libraries(viscera_nodes PUBLIC viscera_session viscera_devices viscera_haptics ${catkin_LIBRARIES} ${interactive_markers_LIBRARIES})

set(VISCERA_NODES "")
foreach(main ${node_mains})
  get_filename_component(stem ${main} NAME_WE)
  string(REGEX REPLACE "_node$" "" node ${stem})
  add_executable(${node} ${main})
  target_compile_options(${node} PRIVATE ${VISCERA_CXX_FLAGS})
  target_link_libraries(${node} PRIVATE viscera_nodes)
  set_target_properties(${node} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${VISCERA_NODE_FOLDER})
  list(APPEND VISCERA_NODES ${node})
endforeach()
