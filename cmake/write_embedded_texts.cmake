# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
# cmake -DOUT=file -DLIST=file -DHEADER=file -DNAMESPACE=name -DITEM=type -P this: writes each of the files that LIST names, one a
# line, as a raw string literal.
cmake_policy(SET CMP0057 NEW)  # IN_LIST
file(STRINGS ${LIST} files)
set(text "#include \"${HEADER}\"\n\nnamespace ${NAMESPACE} {\nconst ${ITEM} k${ITEM}s[] = {\n")
set(names "")
foreach(file ${files})
  get_filename_component(name ${file} NAME)
  if(name IN_LIST names)
    message(FATAL_ERROR "two texts are called ${name}: one is ${file}")
  endif()
  list(APPEND names ${name})
  file(READ ${file} content)
  string(APPEND text "    {\"${name}\", R\"__viscera(${content})__viscera\"},\n")
endforeach()
string(APPEND text "};\nconst int k${ITEM}Count = sizeof(k${ITEM}s) / sizeof(k${ITEM}s[0]);\n}  // namespace ${NAMESPACE}\n")
file(WRITE ${OUT} "${text}")
