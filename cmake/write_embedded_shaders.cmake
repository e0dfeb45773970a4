# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
# cmake -DOUT=file -DFOLDER=dir -P this: writes each file of FOLDER as a raw string literal.
file(GLOB files ${FOLDER}/*)
list(SORT files)
set(text "#include \"gpu/embedded_shaders.h\"\n\nnamespace viscera::gpu {\nconst EmbeddedShader kEmbeddedShaders[] = {\n")
foreach(file ${files})
  get_filename_component(name ${file} NAME)
  file(READ ${file} content)
  string(APPEND text "    {\"${name}\", R\"__viscera(${content})__viscera\"},\n")
endforeach()
string(APPEND text "};\nconst int kEmbeddedShaderCount = sizeof(kEmbeddedShaders) / sizeof(kEmbeddedShaders[0]);\n}  // namespace viscera::gpu\n")
file(WRITE ${OUT} "${text}")
