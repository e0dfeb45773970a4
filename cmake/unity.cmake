# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
# Sources compiled several at a time, as one: what they include is read, and templates are made, once for each group.
# That shortens a build from nothing and lengthens an edit, so that scripts/build asks for it and CMake alone does not.
# Sources with options of their own, such as kernels, stay by themselves: CMake sees to that.
option(VISCERA_UNITY "Compile sources in groups: less for all of them, more for one" OFF)
if(CMAKE_VERSION VERSION_LESS 3.18)  # which cannot be told what belongs to a group
  set(VISCERA_UNITY OFF)
endif()

# What a source declares at the left margin, where namespaces have their contents. Too many names only part sources that need not be.
function(viscera_declared source names)
  file(READ ${source} text)
  string(REGEX REPLACE "\n(using )?namespace[^\n]*" "\n" text "\n${text}")
  string(REGEX REPLACE " ?[][{;=]" "(" text "${text}")  # all that can follow a name; brackets and semicolons mean something to CMake too
  string(REGEX REPLACE "\n((struct|class|union|enum|enum class) [A-Za-z0-9_]+)" "\n\\1(" text "${text}")
  string(REGEX MATCHALL "\n[A-Za-z_][^\n(]*[ &*>][A-Za-z0-9_]+[(]" lines "${text}")
  string(REGEX REPLACE "\n[^;]*[ &*>]([A-Za-z0-9_]+)[(]" "\\1" lines "${lines}")
  string(REGEX MATCHALL ", k[A-Z][A-Za-z0-9_]*[(]" further "${text}")  # constants after the first of a line
  string(REGEX REPLACE ", ([A-Za-z0-9_]+)[(]" "\\1" further "${further}")
  list(APPEND lines ${further})
  list(REMOVE_DUPLICATES lines)
  set(${names} ${lines} PARENT_SCOPE)
  string(REGEX REPLACE "\"[^\"\n]*\"|//[^\n]*" "" text "${text}")  # texts and comments
  string(REGEX MATCHALL "[^A-Za-z0-9_.>:][A-Za-z_][A-Za-z0-9_]+" words "${text}")  # but for members and what is qualified
  list(TRANSFORM words REPLACE "^[^A-Za-z0-9_]" "")
  list(REMOVE_DUPLICATES words)
  set(${names}_seen ${words} PARENT_SCOPE)
endfunction()

# viscera_unity(TARGET SIZE): groups of up to SIZE of the target's sources. Anonymous namespaces of a group become one, so that none
# has a source which declares a name that another one has too, as its own or from a header.
function(viscera_unity target size)
  if(NOT VISCERA_UNITY)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  list(FILTER sources INCLUDE REGEX "\\.cpp$")
  set(count 0)
  foreach(source IN LISTS sources)
    get_filename_component(path ${source} ABSOLUTE)
    viscera_declared(${path} names)
    string(JOIN "|" own ${names})
    set(group 0)
    while(group LESS count)
      if(size_${group} LESS size)
        set(shared ${names_seen} ${names})
        list(FILTER shared INCLUDE REGEX "^(${taken_${group}})$")
        set(hidden ${seen_${group}})
        if(names)
          list(FILTER hidden INCLUDE REGEX "^(${own})$")
        else()
          set(hidden "")
        endif()
        if(NOT shared AND NOT hidden)
          break()
        endif()
      endif()
      math(EXPR group "${group} + 1")
    endwhile()
    if(group EQUAL count)
      math(EXPR count "${count} + 1")
      set(size_${group} 0)
      set(taken_${group} "")
      set(seen_${group} "")
    endif()
    math(EXPR size_${group} "${size_${group}} + 1")
    string(JOIN "|" taken_${group} ${taken_${group}} ${names})
    list(APPEND seen_${group} ${names_seen})
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${target}_${group})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  # It is meant for types in headers, and takes all that a group includes for one.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endfunction()
