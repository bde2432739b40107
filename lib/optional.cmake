# What sinew can do without: each such package is tried by a CMake process of its own before the project asks for
# it, since a package whose files are incomplete ends the configuration of whoever asks, even with QUIET.

# sinew_optional(NAME WHAT text PACKAGES names FIND code [LINK targets] [SOURCE code]): sets SINEW_HAS_NAME: whether
# the CMake code FIND succeeds and SOURCE compiles and links with the targets. SINEW_NAME is AUTO,
# ON or OFF: with ON, a failure is an error. WHAT tells what is left out; PACKAGES are Debian's.
function(sinew_optional name)
  cmake_parse_arguments(PARSE_ARGV 1 ARG "" "WHAT;FIND;SOURCE" "PACKAGES;LINK")  # SOURCE has semicolons
  set(SINEW_${name} AUTO CACHE STRING "${ARG_WHAT}: AUTO (where its packages are there), ON or OFF")
  set_property(CACHE SINEW_${name} PROPERTY STRINGS AUTO ON OFF)
  set(wish "${SINEW_${name}}")
  string(TOUPPER "${wish}" wish)
  set(SINEW_HAS_${name} FALSE PARENT_SCOPE)
  if(NOT wish MATCHES "^(AUTO|ON|OFF|TRUE|FALSE|YES|NO|1|0)$")
    message(FATAL_ERROR "SINEW_${name} is ${SINEW_${name}}; set it to AUTO, ON or OFF")
  endif()
  if(wish MATCHES "^(OFF|FALSE|NO|0)$")
    message(STATUS "Without ${ARG_WHAT} (SINEW_${name} is OFF)")
    return()
  endif()
  sinew_probe(${name} found reason)
  if(found)
    set(SINEW_HAS_${name} TRUE PARENT_SCOPE)
    return()
  endif()
  list(JOIN ARG_PACKAGES " " packages)
  set(log ${PROJECT_BINARY_DIR}/probes/${name}/log.txt)
  if(NOT wish STREQUAL "AUTO")
    message(FATAL_ERROR "SINEW_${name} is ON, and ${reason}; on Debian: "
      "apt-get install --reinstall ${packages} (${log} tells more)")
  endif()
  message(STATUS "Without ${ARG_WHAT}: ${reason} (Debian: apt-get install ${packages})")
endfunction()

# Part of sinew_optional, whose arguments it sees: sets FOUND, and otherwise why not.
function(sinew_probe name found reason)
  set(place ${PROJECT_BINARY_DIR}/probes/${name})
  file(REMOVE_RECURSE ${place})
  file(WRITE ${place}/probe.cpp "${ARG_SOURCE}\n")
  set(build "")
  if(ARG_SOURCE)
    set(build "add_library(probe MODULE probe.cpp)
target_compile_features(probe PRIVATE cxx_std_20)
target_include_directories(probe PRIVATE ${PROJECT_SOURCE_DIR}/lib)
target_link_libraries(probe PRIVATE ${ARG_LINK})")
  endif()
  file(WRITE ${place}/CMakeLists.txt "cmake_minimum_required(VERSION 3.25)
project(probe CXX)
${ARG_FIND}
${build}\n")
  set(settings "-DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER}" "-DCMAKE_CXX_FLAGS=${CMAKE_CXX_FLAGS}"
    "-DCMAKE_PREFIX_PATH=${CMAKE_PREFIX_PATH}")
  if(CMAKE_TOOLCHAIN_FILE)
    list(APPEND settings "-DCMAKE_TOOLCHAIN_FILE=${CMAKE_TOOLCHAIN_FILE}")
  endif()
  set(${found} FALSE PARENT_SCOPE)
  set(${reason} "its packages are missing or incomplete" PARENT_SCOPE)
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${place} -B ${place}/build -G ${CMAKE_GENERATOR} ${settings}
    RESULT_VARIABLE failed OUTPUT_VARIABLE log ERROR_VARIABLE log)
  if(NOT failed)
    execute_process(COMMAND ${CMAKE_COMMAND} --build ${place}/build
      RESULT_VARIABLE failed OUTPUT_VARIABLE more ERROR_VARIABLE more)
    string(APPEND log "${more}")
    set(${reason} "a program that uses it does not build" PARENT_SCOPE)
  endif()
  file(WRITE ${place}/log.txt "${log}")
  if(NOT failed)
    set(${found} TRUE PARENT_SCOPE)
  endif()
endfunction()
