# CVODE 7.1.1 from source: fetched once by cargo from the Rust registry (a crate with SUNDIALS), pinned by its SHA-256,
# built with its own CMake as static, optimized, position-independent code. Alternatives:
#   -DWHEEL_SUNDIALS_SOURCE=<folder>   a source tree of SUNDIALS 7 that you have
set(WHEEL_SUNDIALS_SOURCE "" CACHE PATH "Source tree of SUNDIALS 7; empty: fetch the pinned one")
set(sundials_crate sundials-sys-0.6.2)
set(sundials_sha256 6fbd1d53481b83fc758406097f07b668bf243945e2b1f7db93a8f997cf6b44c9)

# The fetched source is shared by all build folders inside the project. Its folder gets its name last: a fetch that was
# interrupted is done again.
function(fetch_sundials source_dir)
  set(cache ${CMAKE_BINARY_DIR}/_sundials)
  cmake_path(IS_PREFIX CMAKE_SOURCE_DIR ${CMAKE_BINARY_DIR} NORMALIZE inside)
  if(inside)
    set(cache ${CMAKE_SOURCE_DIR}/build/sundials)
  endif()
  set(${source_dir} ${cache}/${sundials_crate}/vendor PARENT_SCOPE)
  file(LOCK ${cache} DIRECTORY GUARD FUNCTION TIMEOUT 900)
  if(EXISTS ${cache}/${sundials_crate})
    return()
  endif()
  find_program(CARGO cargo DOC "fetches the pinned SUNDIALS source")
  if(NOT CARGO)
    message(FATAL_ERROR "cargo is missing: it fetches SUNDIALS. Or give -DWHEEL_SUNDIALS_SOURCE=<folder>.")
  endif()
  message(STATUS "Fetching SUNDIALS (${sundials_crate})")
  set(new ${cache}/new)
  file(REMOVE_RECURSE ${new})
  file(MAKE_DIRECTORY ${new})
  # By a manifest, which cargo of any age reads. Empty packages stand for those that would build the crate.
  set(manifest "[package]\nname = \"@name@\"\nversion = \"@version@\"\n[lib]\npath = \"Cargo.toml\"\n")
  set(patches "[patch.crates-io]\n")
  foreach(of bindgen=0.68.0 cmake=0.1.50 vcpkg=0.2.15 fetch=0.0.0)
    string(REGEX MATCH "(.*)=(.*)" of ${of})
    set(name ${CMAKE_MATCH_1})
    set(version ${CMAKE_MATCH_2})
    string(CONFIGURE "${manifest}" text @ONLY)
    file(WRITE ${new}/${name}/Cargo.toml "${text}")
    string(APPEND patches "${name} = { path = \"../${name}\" }\n")
  endforeach()
  file(APPEND ${new}/fetch/Cargo.toml "[dependencies]\nsundials-sys = \"=0.6.2\"\n${patches}")
  execute_process(
    COMMAND ${CMAKE_COMMAND} -E env CARGO_HOME=${new} ${CARGO} fetch
    WORKING_DIRECTORY ${new}/fetch
    OUTPUT_QUIET
    ERROR_VARIABLE trouble
  )
  set(hash none)
  as_pattern(registry ${new}/registry)
  file(GLOB crate ${registry}/cache/*/${sundials_crate}.crate)
  if(crate)
    file(SHA256 ${crate} hash)
  endif()
  if(NOT hash STREQUAL sundials_sha256)
    message(FATAL_ERROR "SUNDIALS could not be fetched: SHA-256 ${hash}, expected ${sundials_sha256}. ${trouble}")
  endif()
  # Named from here: under the locale C an archive in a folder of other letters than ASCII is not opened.
  file(RELATIVE_PATH crate ${new} ${crate})
  execute_process(
    COMMAND ${CMAKE_COMMAND} -E tar xf ${crate}
    WORKING_DIRECTORY ${new}
    COMMAND_ERROR_IS_FATAL ANY
  )
  file(RENAME ${new}/${sundials_crate} ${cache}/${sundials_crate})
  file(REMOVE_RECURSE ${new})
endfunction()

function(add_sundials)
  set(source ${WHEEL_SUNDIALS_SOURCE})
  if(NOT source)
    fetch_sundials(source)
  endif()
  set(SUNDIALS_SOURCE ${source} PARENT_SCOPE)
  foreach(off BUILD_SHARED_LIBS EXAMPLES_ENABLE_C SUNDIALS_ENABLE_ERROR_CHECKS CMAKE_COMPILE_WARNING_AS_ERROR)
    set(${off} OFF)
  endforeach()
  set(CMAKE_UNITY_BUILD OFF)
  set(SUNDIALS_LOGGING_LEVEL 0)
  set(CMAKE_POLICY_DEFAULT_CMP0069 NEW)
  if(NOT WHEEL_COVERAGE)
    add_compile_options(-ffile-prefix-map=${source}=sundials)
  endif()
  set(CMAKE_MESSAGE_LOG_LEVEL WARNING)
  # SUNDIALS writes the time of its configuration into a header; a fixed one, else each configuration compiles it anew.
  set(ENV{SOURCE_DATE_EPOCH} 315532800) # 1980-01-01
  add_subdirectory(${source} ${CMAKE_BINARY_DIR}/_sundials/build EXCLUDE_FROM_ALL SYSTEM)
endfunction()
