# variables.inc in the build folder: the variables of modelDescription.xml as rows for C and C++.
set(VARIABLE_ROWS_FOLDER ${CMAKE_BINARY_DIR}/generated)
set(VARIABLE_ROWS ${VARIABLE_ROWS_FOLDER}/variables.inc)
file(MAKE_DIRECTORY ${VARIABLE_ROWS_FOLDER})
set(made_from ${CMAKE_SOURCE_DIR}/tools/wheelfmu/fmu/variable_rows.py ${CMAKE_SOURCE_DIR}/modelDescription.xml)
add_custom_command(
  OUTPUT ${VARIABLE_ROWS}
  COMMAND ${Python3_EXECUTABLE} ${made_from} ${VARIABLE_ROWS}
  DEPENDS ${made_from}
  VERBATIM
  COMMENT "Writing the rows of modelDescription.xml"
)
add_custom_target(variable_rows DEPENDS ${VARIABLE_ROWS})
