# Toolchain: cross compilation by zig (PyPI's ziglang carries clang, every libc and the linkers).
#   -DWHEEL_ZIG=<the zig executable> -DWHEEL_ZIG_TARGET=x86_64-linux-gnu.2.17 | x86_64-windows-gnu | aarch64-macos.11.0 |
#   wasm32-wasi ...
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES WHEEL_ZIG WHEEL_ZIG_TARGET)
string(REGEX MATCH "^([a-z0-9_]+)-([a-z]+)" _ "${WHEEL_ZIG_TARGET}")
set(CMAKE_SYSTEM_PROCESSOR ${CMAKE_MATCH_1})
set(system_linux Linux)
set(system_windows Windows)
set(system_macos Darwin)
set(system_wasi Generic) # no shared libraries, no threads, no system below
set(CMAKE_SYSTEM_NAME ${system_${CMAKE_MATCH_2}})
if(CMAKE_SYSTEM_NAME STREQUAL Linux) # CMake does not find out that zig can optimize while linking. It cannot for macOS.
  set(CMAKE_C_FLAGS_INIT -flto)
  set(CMAKE_CXX_FLAGS_INIT -flto)
endif()
set(CMAKE_C_COMPILER ${WHEEL_ZIG} cc -target ${WHEEL_ZIG_TARGET})
set(CMAKE_CXX_COMPILER ${WHEEL_ZIG} c++ -target ${WHEEL_ZIG_TARGET})
foreach(language C CXX)
  set(CMAKE_${language}_ARCHIVE_CREATE "\"${WHEEL_ZIG}\" ar qcD <TARGET> <OBJECTS>")
  set(CMAKE_${language}_ARCHIVE_APPEND "\"${WHEEL_ZIG}\" ar qD <TARGET> <OBJECTS>")
  set(CMAKE_${language}_ARCHIVE_FINISH "\"${WHEEL_ZIG}\" ranlib -D <TARGET>")
endforeach()
set(CMAKE_RC_COMPILER ${WHEEL_ZIG}) # asked for by CMake, never used
# zig brings the headers and libraries of the target itself; packages are the host's (Eigen is headers only).
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
