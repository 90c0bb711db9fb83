# From a table of variables, NAME.csv: modelDescription.xml of the FMU, and variables.hpp with its value references.
#
# Its first line (#) describes the model, the second names the columns, of which only the description may contain commas. Parameters
# come first, then inputs, outputs, locals. {wheel} in a name stands for a variable per wheel, in the order of `wheels`; start then
# lists their values, or has one for all. depends: the inputs on which an output depends directly (* and ? as in names of files; - is none).
set(wheels fl fr rl rr)

# Appends one variable to the lists and texts of describe().
macro(
  add_variable
  kind
  name
  unit
  start
  limit
  depends
  about
)
  set(real "unit=\"${unit}\"")
  set(how "variability=\"continuous\"")
  set(least any)
  if("${limit}" STREQUAL ">0")
    set(least above_0)
  elseif("${limit}" STREQUAL ">=0")
    set(least 0)
  endif()
  if(NOT least STREQUAL "any")
    string(APPEND real " min=\"0\"")
  endif()
  if("${kind}" MATCHES "parameter|input")
    string(APPEND real " start=\"${start}\"")
    string(APPEND STORED "  {\"${name}\", \"${unit}\", ${start}, ${least}},\n")
  else()
    string(APPEND how " initial=\"calculated\"")
  endif()
  if("${kind}" STREQUAL "parameter")
    set(how "variability=\"fixed\" initial=\"exact\"")
  endif()
  string(APPEND REFERENCES "inline constexpr int ${name} = ${count};\n")
  string(
    APPEND VARIABLES
    "    <ScalarVariable name=\"${name}\" valueReference=\"${count}\" causality=\"${kind}\" ${how}\n"
  )
  string(APPEND VARIABLES "      description=\"${about}\"><Real ${real}/></ScalarVariable>\n")
  list(APPEND ${kind}s ${name})
  math(EXPR count "${count} + 1") # and so the variable's index
  if("${kind}" STREQUAL "output")
    list(LENGTH parameters index)
    set(known "")
    foreach(input IN LISTS inputs)
      math(EXPR index "${index} + 1")
      if(input MATCHES "^(${depends})$")
        string(APPEND known " ${index}")
      endif()
    endforeach()
    string(STRIP "${known}" known)
    string(APPEND OUTPUTS "      <Unknown index=\"${count}\" dependencies=\"${known}\"/>\n")
    string(APPEND INITIAL "      <Unknown index=\"${count}\"/>\n")
  endif()
endmacro()

# Writes folder/fmu/modelDescription.xml and folder/variables.hpp.
function(describe table folder)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${table})
  cmake_path(GET table STEM MODEL)
  file(STRINGS ${table} rows)
  list(POP_FRONT rows ABOUT columns)
  string(REGEX REPLACE "^# *" "" ABOUT "${ABOUT}")
  set(count 0)
  set(columns_are "^([a-z]+),([^,]+),([^,]+),([^,]*),([^,]*),([^,]*),(.+)$")
  foreach(row IN LISTS rows)
    if(NOT row MATCHES "${columns_are}")
      message(FATAL_ERROR "${table}: \"${row}\" does not have the columns ${columns}.")
    endif()
    list(APPEND units ${CMAKE_MATCH_3})
    set(value "")
    string(REPLACE " " ";" starts "${CMAKE_MATCH_4}")
    set(each one)
    if(CMAKE_MATCH_2 MATCHES "{wheel}")
      set(each ${wheels})
    endif()
    foreach(wheel start IN ZIP_LISTS each starts)
      if(DEFINED start)
        set(value "${start}")
      endif()
      string(REPLACE "{wheel}" "${wheel}" one "${row}")
      string(REGEX MATCH "${columns_are}" one "${one}")
      string(REPLACE "*" ".*" depends "${CMAKE_MATCH_6}")
      string(REPLACE "?" "." depends "${depends}")
      string(REPLACE " " "|" depends "${depends}")
      add_variable("${CMAKE_MATCH_1}" "${CMAKE_MATCH_2}" "${CMAKE_MATCH_3}" "${value}" "${CMAKE_MATCH_5}" "${depends}"
                         "${CMAKE_MATCH_7}"
      )
    endforeach()
  endforeach()

  list(REMOVE_DUPLICATES units)
  foreach(unit IN LISTS units)
    string(APPEND UNITS "    <Unit name=\"${unit}\"/>\n")
  endforeach()
  foreach(name IN LISTS inputs) # the place of its rate, X_O_dot_fl of X_O_fl
    string(REGEX REPLACE "^([XYZ]_O|delta)((_(fl|fr|rl|rr))?)$" "\\1_dot\\2" rate ${name})
    list(FIND inputs ${rate} place)
    if(rate STREQUAL name)
      set(place -1)
    endif()
    list(APPEND RATES ${place})
  endforeach()
  list(JOIN RATES ", " RATES)
  list(LENGTH parameters FIRST_INPUT)
  list(LENGTH inputs INPUT_COUNT)
  set(COUNT ${count})
  string(MD5 GUID "${ABOUT}${VARIABLES}${OUTPUTS}")
  configure_file(${CMAKE_CURRENT_FUNCTION_LIST_DIR}/modelDescription.xml.in ${folder}/fmu/modelDescription.xml @ONLY)
  configure_file(${CMAKE_CURRENT_FUNCTION_LIST_DIR}/variables.hpp.in ${folder}/variables.hpp @ONLY)
endfunction()
