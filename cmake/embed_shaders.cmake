# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
# Shaders travel inside the program: shaders, and headers that are GLSL too, become strings in one generated source.
# They are found by name alone, whatever their folder, so no two may have the same one.
# usage: viscera_embed_shaders(target folder...)   folders within the project, searched whole
function(viscera_embed_shaders target)
  set(shaders "")
  foreach(folder ${ARGN})
    foreach(pattern *.comp *.vert *.frag *.glsl)
      file(GLOB_RECURSE found CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${folder}/${pattern})
      list(APPEND shaders ${found})
    endforeach()
  endforeach()
  file(GLOB headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/shaders/*.h ${PROJECT_SOURCE_DIR}/shaders/layout/*.h
       ${PROJECT_SOURCE_DIR}/include/viscera/layout/*.h)
  list(APPEND shaders ${headers})
  if(bench IN_LIST ARGN)
    list(APPEND shaders ${PROJECT_SOURCE_DIR}/bench/gw/gw_units.h)
  endif()
  set(out ${PROJECT_BINARY_DIR}/embedded_shaders.cpp)
  set(list ${PROJECT_BINARY_DIR}/embedded_shaders.txt)
  string(REPLACE ";" "\n" lines "${shaders}")
  file(GENERATE OUTPUT ${list} CONTENT "${lines}\n")  # touched only where it changes
  add_custom_command(
    OUTPUT ${out}
    COMMAND ${CMAKE_COMMAND} -DOUT=${out} -DLIST=${list} -P ${PROJECT_SOURCE_DIR}/cmake/write_embedded_shaders.cmake
    DEPENDS ${shaders} ${list} ${PROJECT_SOURCE_DIR}/cmake/write_embedded_shaders.cmake
    COMMENT "Embedding shaders")
  target_sources(${target} PRIVATE ${out})
endfunction()
