# The FMI 2.0 headers, the GUID (from modelDescription.xml), and the FMU archive.
include(fmi_headers)

set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS modelDescription.xml)
file(STRINGS modelDescription.xml guid_line REGEX "guid=")
string(REGEX REPLACE ".*guid=\"([^\"]*)\".*" "\\1" WHEEL_GUID "${guid_line}")

# The folder under binaries/ in which masters look on the machine that it is built for, whatever its processor:
# docs/decisions/platform_folders.md.
if(WIN32)
  set(wheel_platform win64)
elseif(APPLE)
  set(wheel_platform darwin64)
else()
  set(wheel_platform linux64)
endif()

# wheel.fmu in the build folder: description, library, documentation, licences; same commit, same bytes.
function(add_fmu target)
  set(fmu ${CMAKE_BINARY_DIR}/wheel.fmu)
  set(packer ${CMAKE_SOURCE_DIR}/cmake/pack_fmu.py)
  file(GLOB_RECURSE contents CONFIGURE_DEPENDS fmu-src/archive/*)
  # Eigen's licence: beside its headers, or in Debian's package.
  get_target_property(eigen Eigen3::Eigen INTERFACE_INCLUDE_DIRECTORIES)
  find_file(
    EIGEN_LICENSE
    NAMES COPYING.MPL2 copyright
    HINTS ${eigen} ${eigen}/../../share/doc/libeigen3-dev
    NO_DEFAULT_PATH
    NO_CMAKE_FIND_ROOT_PATH
  )
  set(licences --licence sundials-license.txt ${SUNDIALS_SOURCE}/LICENSE)
  list(APPEND licences --licence sundials-notice.txt ${SUNDIALS_SOURCE}/NOTICE)
  list(APPEND licences --notice fmi-headers-notice.txt ${FMI2_INCLUDE_DIR}/fmi2Functions.h)
  if(EIGEN_LICENSE)
    list(APPEND licences --licence eigen-license.txt ${EIGEN_LICENSE})
  endif()
  if(TARGET libm)
    list(APPEND licences --notice fdlibm-notice.txt ${LIBM_FOLDER}/s_sin.c)
    list(APPEND licences --notice arm-math-license.txt ${LIBM_FOLDER}/pow.c)
  endif()
  add_custom_command(
    OUTPUT ${fmu}
    COMMAND
      ${Python3_EXECUTABLE} ${packer} --output ${fmu} ${licences} --platform ${wheel_platform} --library
      $<TARGET_FILE:${target}>
    DEPENDS ${target} ${packer} ${contents} modelDescription.xml LICENSE
    COMMENT "Packing wheel.fmu"
  )
  add_custom_target(fmu ALL DEPENDS ${fmu})
endfunction()
