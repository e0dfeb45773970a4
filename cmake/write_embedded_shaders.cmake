# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
# cmake -DOUT=file -DLIST=file -P this: writes each of the files that LIST names, one a line, as a raw string literal.
cmake_policy(SET CMP0057 NEW)  # IN_LIST
file(STRINGS ${LIST} files)
set(text "#include \"gpu/embedded_shaders.h\"\n\nnamespace viscera::gpu {\nconst EmbeddedShader kEmbeddedShaders[] = {\n")
set(names "")
foreach(file ${files})
  get_filename_component(name ${file} NAME)
  if(name IN_LIST names)
    message(FATAL_ERROR "two shaders are called ${name}: one is ${file}")
  endif()
  list(APPEND names ${name})
  file(READ ${file} content)
  string(APPEND text "    {\"${name}\", R\"__viscera(${content})__viscera\"},\n")
endforeach()
string(APPEND text "};\nconst int kEmbeddedShaderCount = sizeof(kEmbeddedShaders) / sizeof(kEmbeddedShaders[0]);\n}  // namespace viscera::gpu\n")
file(WRITE ${OUT} "${text}")
