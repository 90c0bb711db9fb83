# Flags of every target. No -ffast-math and no contraction to fused multiply-add: the same bits from every compiler that
# keeps IEEE rules. Exceptions and run-time types are not used; nothing throws across the C interface.
set(CMAKE_C_STANDARD 11)
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_C_VISIBILITY_PRESET hidden)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
# On macOS no path of the building machine as a library's own name.
set(CMAKE_INSTALL_NAME_DIR @rpath)
set(CMAKE_BUILD_WITH_INSTALL_NAME_DIR ON)
add_compile_options(-ffp-contract=off -fno-math-errno)
include(arithmetic)
# No path of the building machine in the binary: two builds in two folders are the same bytes. Only gcov needs the paths.
if(NOT WHEEL_COVERAGE)
  add_compile_options(-ffile-prefix-map=${CMAKE_SOURCE_DIR}=. -ffile-prefix-map=${CMAKE_BINARY_DIR}=.)
endif()

if(CMAKE_BUILD_TYPE STREQUAL Release AND NOT WHEEL_SANITIZE)
  include(CheckIPOSupported)
  check_ipo_supported(RESULT CMAKE_INTERPROCEDURAL_OPTIMIZATION OUTPUT reason LANGUAGES C CXX)
endif()

# Our own code: the fuzzer is not to chase branches inside CVODE, whose coverage shows nothing either.
add_library(wheel_options INTERFACE)
set(warnings "-Wall;-Wextra;-Wpedantic;-Wshadow;-Wconversion;-Wno-sign-conversion")
target_compile_options(wheel_options INTERFACE ${warnings})
target_compile_options(wheel_options INTERFACE "$<$<COMPILE_LANGUAGE:CXX>:-fno-exceptions;-fno-rtti;-Wold-style-cast>")
target_compile_options(wheel_options INTERFACE $<$<BOOL:${WHEEL_FUZZ}>:-fsanitize=fuzzer-no-link>)
if(WHEEL_COVERAGE)
  target_compile_options(wheel_options INTERFACE --coverage -fprofile-update=atomic -Og)
  add_link_options(--coverage)
endif()
if(WHEEL_SANITIZE)
  add_compile_options(-fsanitize=${WHEEL_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${WHEEL_SANITIZE})
endif()

# Needs libc and libm only, exports fmi2* only.
function(link_self_contained target)
  set_target_properties(${target} PROPERTIES PREFIX "")
  if(NOT APPLE AND NOT WIN32)
    # A copy, named as the linker sees it: a "$" in a folder's name would not reach the linker.
    configure_file(cmake/exports.map exports.map COPYONLY)
    target_link_options(${target} PRIVATE -Wl,--version-script=exports.map -Wl,--gc-sections -Wl,--build-id=none)
    set_property(TARGET ${target} APPEND PROPERTY LINK_DEPENDS ${CMAKE_CURRENT_BINARY_DIR}/exports.map)
    if(NOT WHEEL_SANITIZE)
      target_link_options(${target} PRIVATE -static-libgcc -static-libstdc++ -Wl,--no-undefined)
    endif()
  endif()
endfunction()
