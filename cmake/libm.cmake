# One libm for every platform: sin, cos and the rest from musl's sources (MIT), compiled in, so that
# trajectories agree to the bit. The releases use it; other builds take the system's libm.
set(WHEEL_LIBM_SOURCE "" CACHE PATH "musl's folder (with src/math) to link its libm in; empty: the system's libm")

function(link_libm target)
  if(NOT WHEEL_LIBM_SOURCE)
    return()
  endif()
  set(sources)
  foreach(
    name
    sin
    cos
    sincos
    __sin
    __cos
    __rem_pio2
    __rem_pio2_large
    tanh
    cosh
    expm1
    exp
    exp_data
    pow
    pow_data
    __expo2
    __math_divzero
    __math_invalid
    __math_oflow
    __math_uflow
    __math_xflow
  )
    list(APPEND sources ${WHEEL_LIBM_SOURCE}/src/math/${name}.c)
  endforeach()
  add_library(musl_libm OBJECT ${sources})
  set_target_properties(musl_libm PROPERTIES INTERPROCEDURAL_OPTIMIZATION OFF)
  # What these sources take from headers that other systems lack or have otherwise; exact functions come from the
  # compiler. Without __FP_FAST_FMA pow takes the same path on every processor.
  set(shim ${CMAKE_BINARY_DIR}/libm_shim)
  file(WRITE ${shim}/endian.h "#define __LITTLE_ENDIAN 1234\n#define __BIG_ENDIAN 4321\n#define __BYTE_ORDER 1234\n")
  file(
    WRITE ${shim}/features.h
    "#if __has_include_next(<features.h>)\n#include_next <features.h>\n#endif\n"
    "#define hidden __attribute__((visibility(\"hidden\")))\n"
  )
  file(
    WRITE ${shim}/math.h
    "#include <features.h>\ntypedef double double_t;\n#define isnan __builtin_isnan\n#define fabs __builtin_fabs\n"
    "#define scalbn __builtin_scalbn\n#define floor __builtin_floor\n"
    "#ifndef INFINITY\n#define INFINITY __builtin_inff()\n#endif\n"
    "double sin(double), cos(double), tanh(double), cosh(double), exp(double), expm1(double), pow(double, double);\n"
  )
  target_include_directories(
    musl_libm
    BEFORE
    PRIVATE ${shim} ${WHEEL_LIBM_SOURCE}/src/internal ${WHEEL_LIBM_SOURCE}/arch/generic
  )
  target_compile_options(musl_libm PRIVATE -w -fno-builtin -U__FP_FAST_FMA -ffile-prefix-map=${WHEEL_LIBM_SOURCE}=musl)
  target_sources(${target} PRIVATE $<TARGET_OBJECTS:musl_libm>)
  # Eigen's vector code fuses multiply and add on arm.
  target_compile_definitions(wheel_options INTERFACE EIGEN_DONT_VECTORIZE)
  # Apple's and mingw's compilers would merge sin and cos into a call of their own.
  target_compile_options(wheel_options INTERFACE -fno-builtin-sin -fno-builtin-cos)
endfunction()
