# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
# Messages of packages that Debian lacks, so that their packages are not needed to talk to their drivers: gencpp makes
# their headers from src/nodes/foreign/PACKAGE/msg/NAME.msg. catkin does not know them: they are not ours to install.
set(VISCERA_FOREIGN_INCLUDE ${PROJECT_BINARY_DIR}/foreign)
set(VISCERA_FOREIGN_HEADERS "")
file(GLOB foreign_packages CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/nodes/foreign/*)
set(foreign_paths "")
foreach(package std_msgs geometry_msgs)
  foreach(folder ${${package}_MSG_INCLUDE_DIRS})  # as generate_messages has found them
    list(APPEND foreign_paths -I${package}:${folder})
  endforeach()
endforeach()
foreach(folder ${foreign_packages})
  get_filename_component(package ${folder} NAME)
  list(APPEND foreign_paths -I${package}:${folder}/msg)
endforeach()
foreach(folder ${foreign_packages})
  get_filename_component(package ${folder} NAME)
  file(GLOB messages CONFIGURE_DEPENDS ${folder}/msg/*.msg)
  foreach(message ${messages})
    get_filename_component(name ${message} NAME_WE)
    set(header ${VISCERA_FOREIGN_INCLUDE}/${package}/${name}.h)
    add_custom_command(OUTPUT ${header} DEPENDS ${messages} ${GENCPP_BIN}
      COMMAND ${CATKIN_ENV} ${PYTHON_EXECUTABLE} ${GENCPP_BIN} ${message} ${foreign_paths} -p ${package}
              -o ${VISCERA_FOREIGN_INCLUDE}/${package} -e ${GENCPP_TEMPLATE_DIR}
      COMMENT "Generating C++ code from ${package}/${name}.msg" VERBATIM)
    list(APPEND VISCERA_FOREIGN_HEADERS ${header})
  endforeach()
endforeach()
