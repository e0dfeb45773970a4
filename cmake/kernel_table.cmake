# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
# Writes the classes of all kernels of a list (src/solver/device/kernels.txt), one for every choice of features, and
# kKernels, the table in which CpuDevice finds them: to be included within namespace viscera::glsl.
function(viscera_kernel_table list base out)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${list})
  file(STRINGS ${list} lines REGEX "^[^#]")
  foreach(line ${lines})
    string(REGEX MATCHALL "[^ ]+" words "${line} NOTHING")  # where there is no choice
    list(GET words 0 shader)
    list(GET words 1 always)
    list(GET words 2 choosable)
    get_filename_component(name ${shader} NAME)
    set(choices ${always})
    string(REPLACE "," ";" features ${choosable})
    list(REMOVE_ITEM features NOTHING)
    foreach(feature ${features})
      foreach(choice ${choices})
        list(APPEND choices ${choice},${feature})
      endforeach()
    endforeach()
    foreach(choice ${choices})
      string(REPLACE "," "_" class ${name}_${choice})
      string(APPEND classes "#define VARIANT_NAME ${class}\n#define VARIANT_BASE ${base}\n"
                            "#define VARIANT_TEXT \"shaders/solver/${shader}.comp\"\n"
                            "#define VARIANT_FEATURES WITH_${choice}\n"
                            "#include \"solver/cpu/kernels/glsl_variant.inc\"\n\n")
      string(APPEND rows "    {\"${name}.comp\", WITH_${choice}, WITH_${choosable}, runVariant<${class}>},\n")
    endforeach()
  endforeach()
  set(text "${classes}constexpr KernelRow kKernels[] = {\n${rows}};\n")
  string(REGEX REPLACE "([A-Z]),([A-Z])" "\\1 | WITH_\\2" text "${text}")  # A,B: WITH_A | WITH_B
  file(GENERATE OUTPUT ${out} CONTENT "${text}")
endfunction()
