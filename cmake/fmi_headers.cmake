# The Python of .venv and the FMI 2.0 headers, which come with its package fmpy; for the project and for examples/.
set(Python3_FIND_VIRTUALENV FIRST)
if(NOT Python3_EXECUTABLE AND EXISTS ${CMAKE_CURRENT_LIST_DIR}/../.venv/bin/python)
  set(Python3_EXECUTABLE ${CMAKE_CURRENT_LIST_DIR}/../.venv/bin/python)
endif()
find_package(Python3 REQUIRED QUIET COMPONENTS Interpreter)

# CMake would ask it for this folder with the current folder's modules in front.
execute_process(
  COMMAND ${Python3_EXECUTABLE} -I -c "import sysconfig; print(sysconfig.get_path('purelib'))"
  OUTPUT_VARIABLE packages
  OUTPUT_STRIP_TRAILING_WHITESPACE
)
find_path(FMI2_INCLUDE_DIR fmi2Functions.h HINTS ${packages}/fmpy/c-code NO_DEFAULT_PATH NO_CMAKE_FIND_ROOT_PATH)
if(NOT FMI2_INCLUDE_DIR)
  message(
    FATAL_ERROR
    "fmi2Functions.h is missing: ./scripts/setup installs it and all else; or set FMI2_INCLUDE_DIR to its folder."
  )
endif()
