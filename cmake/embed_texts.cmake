# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
# Texts travel inside the program: files become strings in one generated source. They are found by name alone, whatever their
# folder, so no two may have the same one.
# usage: viscera_embed_texts(target HEADER NAMESPACE ITEM file...)
#   HEADER  declares k${ITEM}s, an array of ITEM (name, text), and k${ITEM}Count, in NAMESPACE
function(viscera_embed_texts target header namespace item)
  get_filename_component(stem ${header} NAME_WE)
  set(out ${PROJECT_BINARY_DIR}/${stem}.cpp)
  set(list ${PROJECT_BINARY_DIR}/${stem}.txt)
  string(REPLACE ";" "\n" lines "${ARGN}")
  file(GENERATE OUTPUT ${list} CONTENT "${lines}\n")  # touched only where it changes
  add_custom_command(
    OUTPUT ${out}
    COMMAND ${CMAKE_COMMAND} -DOUT=${out} -DLIST=${list} -DHEADER=${header} -DNAMESPACE=${namespace} -DITEM=${item} -P
            ${PROJECT_SOURCE_DIR}/cmake/write_embedded_texts.cmake
    DEPENDS ${ARGN} ${list} ${PROJECT_SOURCE_DIR}/cmake/write_embedded_texts.cmake
    COMMENT "Embedding ${stem}"
    VERBATIM)
  target_sources(${target} PRIVATE ${out})
endfunction()

# Shaders, and headers that are GLSL too. usage: viscera_embed_shaders(target folder...)   folders within the project, searched whole
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
  viscera_embed_texts(${target} gpu/embedded_shaders.h viscera::gpu EmbeddedShader ${shaders})
endfunction()
