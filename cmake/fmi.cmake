# The FMI 2.0 headers, the GUID (from modelDescription.xml), and the FMU archive.
include(fmi_headers)

set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS modelDescription.xml)
file(STRINGS modelDescription.xml guid_line REGEX "guid=")
string(REGEX REPLACE ".*guid=\"([^\"]*)\".*" "\\1" WHEEL_GUID "${guid_line}")

# The folder under binaries/ in which masters look on the machine that it is built for, whatever its processor:
# docs/decisions/package.md.
string(TOLOWER ${CMAKE_SYSTEM_NAME}64 wheel_platform)
string(REPLACE windows win wheel_platform ${wheel_platform})

# wheel.fmu in the build folder: description, library, documentation, licences; same commit, same bytes.
function(add_fmu target)
  set(fmu ${CMAKE_BINARY_DIR}/wheel.fmu)
  set(packer ${CMAKE_SOURCE_DIR}/tools/wheelfmu/fmu/pack_fmu.py)
  as_pattern(archive ${CMAKE_SOURCE_DIR}/fmu-src/archive)
  file(GLOB_RECURSE contents CONFIGURE_DEPENDS ${archive}/*)
  # Eigen's licence: beside its headers, or in Debian's package.
  get_target_property(eigen Eigen3::Eigen INTERFACE_INCLUDE_DIRECTORIES)
  as_pattern(eigen ${eigen})
  file(GLOB eigen_license ${eigen}/COPYING.MPL2 ${eigen}/../../share/doc/libeigen3-dev/copyright)
  set(
    licences
    sundials-license.txt=${SUNDIALS_SOURCE}/LICENSE
    sundials-notice.txt=${SUNDIALS_SOURCE}/NOTICE
    fmi-headers-notice.txt=${FMI2_INCLUDE_DIR}/fmi2Functions.h
    $<$<BOOL:${eigen_license}>:eigen-license.txt=${eigen_license}>
    $<$<TARGET_EXISTS:libm>:fdlibm-notice.txt=${LIBM_FOLDER}/s_sin.c>
    $<$<TARGET_EXISTS:libm>:arm-math-license.txt=${LIBM_FOLDER}/pow.c>
  )
  add_custom_command(
    OUTPUT ${fmu}
    COMMAND ${Python3_EXECUTABLE} ${packer} ${fmu} ${wheel_platform} $<TARGET_FILE:${target}> ${licences}
    COMMAND_EXPAND_LISTS
    VERBATIM
    DEPENDS ${target} ${packer} ${contents} modelDescription.xml LICENSE
    COMMENT "Packing wheel.fmu"
  )
  add_custom_target(fmu ALL DEPENDS ${fmu})
endfunction()
