# Results are the same bits where the compiler keeps the rules of IEEE 754. Options that relax them are refused, by any
# name: by the macros that compilers define, and by a program's results. A cross compiler's program does not run here.
include(CheckSourceCompiles)
include(CheckSourceRuns)

function(check_arithmetic language)
  string(TOUPPER CMAKE_${language}_FLAGS_${CMAKE_BUILD_TYPE} more)
  string(STRIP "${CMAKE_${language}_FLAGS} ${${more}} ${CMAKE_SHARED_LINKER_FLAGS}" flags)
  string(MD5 key "${CMAKE_${language}_COMPILER} ${flags}")
  set(CMAKE_TRY_COMPILE_CONFIGURATION ${CMAKE_BUILD_TYPE})
  set(CMAKE_EXE_LINKER_FLAGS "${CMAKE_EXE_LINKER_FLAGS} ${CMAKE_SHARED_LINKER_FLAGS}")
  set(CMAKE_REQUIRED_FLAGS -ffp-contract=off)
  set(CMAKE_REQUIRED_QUIET ON)
  file(READ ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/arithmetic.c program)
  set(way runs)
  if(CMAKE_CROSSCOMPILING)
    set(way compiles)
  endif()
  cmake_language(CALL check_source_${way} ${language} "${program}" arithmetic_${key})
  if(NOT arithmetic_${key})
    message(
      FATAL_ERROR
      "Results would not be bit-identical: with \"${flags}\" the ${language} compiler does not keep IEEE 754. Leave out -ffast-math, its parts and their like."
    )
  endif()
endfunction()

check_arithmetic(C)
check_arithmetic(CXX)
