# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
# Shaders travel inside the program: every file of shaders/ becomes a string in one generated source.
function(viscera_embed_shaders target)
  file(GLOB shaders CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/shaders/*)
  set(out ${PROJECT_BINARY_DIR}/embedded_shaders.cpp)
  add_custom_command(
    OUTPUT ${out}
    COMMAND ${CMAKE_COMMAND} -DOUT=${out} -DFOLDER=${PROJECT_SOURCE_DIR}/shaders -P
            ${PROJECT_SOURCE_DIR}/cmake/write_embedded_shaders.cmake
    DEPENDS ${shaders} ${PROJECT_SOURCE_DIR}/cmake/write_embedded_shaders.cmake
    COMMENT "Embedding shaders")
  target_sources(${target} PRIVATE ${out})
endfunction()
