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
add_compile_options(-ffp-contract=off -fno-math-errno)
# No path of the building machine in the binary: two builds in two folders are the same bytes. Only gcov needs the paths.
if(NOT WHEEL_COVERAGE)
  add_compile_options(-ffile-prefix-map=${CMAKE_SOURCE_DIR}=. -ffile-prefix-map=${CMAKE_BINARY_DIR}=.)
endif()

include(CheckIPOSupported)
check_ipo_supported(RESULT ipo OUTPUT reason LANGUAGES C CXX)
if(ipo AND CMAKE_BUILD_TYPE STREQUAL Release AND NOT WHEEL_SANITIZE)
  set(CMAKE_INTERPROCEDURAL_OPTIMIZATION ON)
endif()

# Our own code: the fuzzer is not to chase branches inside CVODE, whose coverage shows nothing either.
add_library(wheel_options INTERFACE)
target_compile_options(
  wheel_options
  INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
)
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
  # On macOS no path of the building machine as the library's own name.
  set_target_properties(
    ${target}
    PROPERTIES PREFIX "" INSTALL_NAME_DIR @rpath BUILD_WITH_INSTALL_NAME_DIR ON
  )
  if(NOT APPLE AND NOT WIN32)
    set(exports ${CMAKE_CURRENT_SOURCE_DIR}/cmake/exports.map)
    target_link_options(${target} PRIVATE -Wl,--version-script=${exports} -Wl,--gc-sections -Wl,--build-id=none)
    set_property(TARGET ${target} APPEND PROPERTY LINK_DEPENDS ${exports})
  endif()
  if(NOT APPLE AND NOT WIN32 AND NOT WHEEL_SANITIZE)
    target_link_options(${target} PRIVATE -static-libgcc -static-libstdc++ -Wl,--no-undefined)
  endif()
endfunction()
