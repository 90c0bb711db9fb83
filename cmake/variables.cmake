# variables.inc in the build folder: the variables of modelDescription.xml as rows for C and C++.
set(VARIABLE_ROWS_FOLDER ${CMAKE_BINARY_DIR}/generated)
set(VARIABLE_ROWS ${VARIABLE_ROWS_FOLDER}/variables.inc)
file(MAKE_DIRECTORY ${VARIABLE_ROWS_FOLDER})
add_custom_command(
  OUTPUT ${VARIABLE_ROWS}
  COMMAND
    ${Python3_EXECUTABLE} ${CMAKE_SOURCE_DIR}/cmake/variable_rows.py ${CMAKE_SOURCE_DIR}/modelDescription.xml
    ${VARIABLE_ROWS}
  DEPENDS ${CMAKE_SOURCE_DIR}/cmake/variable_rows.py ${CMAKE_SOURCE_DIR}/modelDescription.xml
  COMMENT "Writing the rows of modelDescription.xml"
)
