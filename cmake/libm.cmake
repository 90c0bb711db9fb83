# One libm for every build: sin, cos and the rest from newlib's sources (FDLIBM, and Arm's exp and pow), compiled in, so
# that trajectories have the same bits on every processor and system: docs/decisions/package.md. Debian's package
# newlib-source has them; its versions in Debian 12 and 13 give the same bits. Alternatives:
#   -DWHEEL_LIBM_SOURCE=<newlib's source tree, or its archive>
#   -DWHEEL_LIBM_SOURCE=system   the system's libm, whose last bits depend on the processor
set(WHEEL_LIBM_SOURCE "" CACHE STRING "newlib's source tree or archive; empty: Debian's; system: the system's libm")
set(
  libm_sha256
  3186e6cecc99c7f48b1d045bb8031da417db652da33439c80f885763af6b7ddd # 3.3.0, Debian 12
  32f41240daa3f050c6cef212a39b85bb9b120a202646763a12571db0867a0a72 # 4.5.0, Debian 13
)
# Each behind those that it calls: a linker that has met a call takes the function from the C library.
set(libm_compiled "common/math_err.c;common/exp_data.c;common/pow_log_data.c;common/exp.c;common/s_expm1.c")
list(APPEND libm_compiled "common/pow.c;math/k_rem_pio2.c;math/s_tanh.c;math/e_cosh.c")
# Read by cmake/libm/trigonometry.c, or headers.
set(libm_included "math/k_sin.c;math/k_cos.c;math/e_rem_pio2.c;math/s_sin.c;math/s_cos.c;common/math_config.h")

# One hash for the files of these names in a folder.
function(hash_of result folder)
  set(hashes "")
  foreach(name ${ARGN})
    set(hash absent)
    if(EXISTS ${folder}/${name})
      file(SHA256 ${folder}/${name} hash)
    endif()
    list(APPEND hashes ${hash})
  endforeach()
  string(SHA256 hash "${hashes}")
  set(${result} ${hash} PARENT_SCOPE)
endfunction()

# The files in one folder, from an archive or a tree: beside each other, but without newlib's own fdlibm.h. Those of an
# archive are unpacked once.
function(unpack_libm folder)
  set(tree ${WHEEL_LIBM_SOURCE})
  if(NOT tree)
    file(GLOB tree /usr/src/newlib/newlib-*.tar.xz)
  endif()
  if(NOT EXISTS "${tree}")
    message(FATAL_ERROR "The source of libm is missing: install Debian's newlib-source, or see cmake/libm.cmake.")
  endif()
  list(TRANSFORM ARGN REPLACE ".*/" "" OUTPUT_VARIABLE names)
  hash_of(hash ${folder} ${names})
  if(hash IN_LIST libm_sha256 AND tree STREQUAL libm_unpacked AND NOT IS_DIRECTORY ${tree})
    return()
  endif()
  set(libm_unpacked ${tree} CACHE INTERNAL "source of the files in _libm")
  if(NOT IS_DIRECTORY ${tree})
    list(TRANSFORM ARGN PREPEND "*/newlib/libm/" OUTPUT_VARIABLE patterns)
    file(ARCHIVE_EXTRACT INPUT ${tree} DESTINATION ${folder}/archive PATTERNS ${patterns})
    as_pattern(archive ${folder}/archive)
    file(GLOB tree ${archive}/*)
  endif()
  foreach(name ${ARGN})
    file(COPY ${tree}/newlib/libm/${name} DESTINATION ${folder})
  endforeach()
  file(REMOVE_RECURSE ${folder}/archive)
  hash_of(hash ${folder} ${names})
  if(NOT hash IN_LIST libm_sha256)
    message(FATAL_ERROR "The libm in ${tree} is not a known one: SHA-256 ${hash}, expected ${libm_sha256}.")
  endif()
endfunction()

function(link_libm target)
  if(TARGET libm)
    get_target_property(type ${target} TYPE)
    set(where PRIVATE)
    if(type STREQUAL STATIC_LIBRARY) # in an archive they would come too late: behind those of the C library
      set(where INTERFACE)
    endif()
    target_sources(${target} ${where} $<TARGET_OBJECTS:libm>)
  endif()
endfunction()

# Eigen's vector code sums in another order, and on arm fuses multiply and add.
target_compile_definitions(wheel_options INTERFACE EIGEN_DONT_VECTORIZE)
if(WHEEL_LIBM_SOURCE STREQUAL system)
  return()
endif()
# The objects that link_libm links.
set(LIBM_FOLDER ${CMAKE_BINARY_DIR}/_libm)
unpack_libm(${LIBM_FOLDER} ${libm_compiled} ${libm_included})
list(TRANSFORM libm_compiled REPLACE ".*/" ${LIBM_FOLDER}/)
add_library(libm OBJECT ${libm_compiled} cmake/libm/trigonometry.c)
set_target_properties(
  libm
  PROPERTIES UNITY_BUILD OFF INTERPROCEDURAL_OPTIMIZATION OFF EXPORT_COMPILE_COMMANDS OFF
)
target_include_directories(libm PRIVATE cmake/libm ${LIBM_FOLDER})
target_compile_definitions(libm PRIVATE WANT_ERRNO=0 HAVE_FAST_FMA=0)
separate_arguments(own UNIX_COMMAND "sin cos sincos tanh cosh exp expm1 pow")
list(TRANSFORM own PREPEND -fno-builtin-)
target_compile_options(libm PRIVATE -w -fno-lto ${own})
if(WHEEL_SANITIZE) # it shifts negative numbers, which every compiler here does alike
  target_compile_options(libm PRIVATE -fno-sanitize=all)
endif()
# Apple's compiler would merge sin and cos into a call of the system's.
target_compile_options(wheel_options INTERFACE "$<$<PLATFORM_ID:Darwin>:-fno-builtin-sin;-fno-builtin-cos>")
