# How every room of lib becomes a library sinew::ROOM, installed for find_package(sinew).

# What holds for all our own code: the language, its warnings, and bits that do not depend on fused
# multiply-adds. Tests draw random numbers and count without asking how wide they are. GCC takes sources that
# are compiled together for headers, whose types must not depend on anonymous namespaces; from 13 on it suspects
# references that functions return to be to their temporary arguments. -fpch-preprocess lets compiler caches
# take part where headers are precompiled.
set(SINEW_COMPILE_OPTIONS -Wall -Wextra -Wconversion -Wshadow -Wnon-virtual-dtor -ffp-contract=off
  $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>
  $<$<BOOL:${SINEW_UNITY}>:-Wno-subobject-linkage>
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_GREATER_EQUAL:$<CXX_COMPILER_VERSION>,13>>:-Wno-dangling-reference> $<$<BOOL:${SINEW_STRICT}>:-Werror>)
foreach(kind options test_options)
  add_library(sinew_${kind} INTERFACE)
  target_compile_features(sinew_${kind} INTERFACE cxx_std_20)
  target_compile_options(sinew_${kind} INTERFACE ${SINEW_COMPILE_OPTIONS})
endforeach()
target_compile_options(sinew_test_options INTERFACE -Wno-conversion)

# A third of the time of compiling is headers that all rooms include: these are compiled once, with
# core, and with settings for the light rooms, because GCC optimizes as the precompiled header was.
# -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON shows who forgot an include.
set(SINEW_INCLUDED_BY_ALL <Eigen/Core> <Eigen/Geometry> <algorithm> <array> <cmath> <filesystem> <functional> <map>
  <memory> <optional> <span> <string> <variant> <vector>)

# sinew_library(ROOM [LIGHT] [OWN] SOURCES ... CGAL_SOURCES ... PUBLIC targets PRIVATE targets HEADERS names)
# LIGHT rooms prepare and report: they are compiled fast rather than optimized. OWN ones are for one of our
# programs alone, and not installed. Headers are installed but for those in detail/, or those in HEADERS alone. CGAL asks for -frounding-math:
# only its own sources get that.
function(sinew_library room)
  cmake_parse_arguments(ARG "LIGHT;OWN" "" "SOURCES;CGAL_SOURCES;PUBLIC;PRIVATE;HEADERS" ${ARGN})
  add_library(sinew_${room} STATIC ${ARG_SOURCES})
  add_library(sinew::${room} ALIAS sinew_${room})
  set_target_properties(sinew_${room} PROPERTIES EXPORT_NAME ${room} POSITION_INDEPENDENT_CODE ON
    UNITY_BUILD ${SINEW_UNITY} UNITY_BUILD_BATCH_SIZE 16)
  target_include_directories(sinew_${room} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/lib> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(sinew_${room} PUBLIC cxx_std_20)
  target_link_libraries(sinew_${room}
    PUBLIC ${ARG_PUBLIC} PRIVATE $<BUILD_INTERFACE:sinew_options> ${ARG_PRIVATE})
  if(ARG_LIGHT)
    target_compile_options(sinew_${room} PRIVATE $<$<CONFIG:Release>:-O1>)
    set(first settings)
  else()
    set(first core)
  endif()
  if(room STREQUAL first)
    target_precompile_headers(sinew_${room} PRIVATE ${SINEW_INCLUDED_BY_ALL})
  else()
    target_precompile_headers(sinew_${room} REUSE_FROM sinew_${first})
  endif()
  if(ARG_CGAL_SOURCES)
    find_package(CGAL 5.5 REQUIRED)
    add_library(sinew_${room}_cgal OBJECT ${ARG_CGAL_SOURCES})
    set_target_properties(sinew_${room}_cgal PROPERTIES POSITION_INDEPENDENT_CODE ON
      JOB_POOL_COMPILE ${SINEW_HEAVY})
    target_include_directories(sinew_${room}_cgal PRIVATE ${PROJECT_SOURCE_DIR}/lib)
    # CGAL 6 warns of the names that headers have in CGAL 5.
    target_compile_definitions(sinew_${room}_cgal PRIVATE CGAL_NO_DEPRECATION_WARNINGS)
    target_link_libraries(sinew_${room}_cgal PRIVATE sinew_options ${ARG_PUBLIC} CGAL::CGAL)
    if(room STREQUAL mesh)  # the first room with such sources: CGAL's headers are compiled once, for all
      target_precompile_headers(sinew_mesh_cgal PRIVATE <CGAL/AABB_traits.h> <CGAL/AABB_tree.h>
        <CGAL/Exact_predicates_inexact_constructions_kernel.h> <CGAL/Surface_mesh.h> ${SINEW_INCLUDED_BY_ALL})
    else()
      target_precompile_headers(sinew_${room}_cgal REUSE_FROM sinew_mesh_cgal)
    endif()
    target_sources(sinew_${room} PRIVATE $<TARGET_OBJECTS:sinew_${room}_cgal>)
    target_link_libraries(sinew_${room} PRIVATE $<LINK_ONLY:CGAL::CGAL>)
  endif()
  if(ARG_OWN)
    return()
  endif()
  install(TARGETS sinew_${room} EXPORT sinew ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
    COMPONENT libsinew-dev)
  if(ARG_HEADERS)
    install(FILES ${ARG_HEADERS} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/sinew/${room} COMPONENT libsinew-dev)
  else()
    install(DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/sinew/${room}
      COMPONENT libsinew-dev FILES_MATCHING PATTERN "*.h" PATTERN detail EXCLUDE)
  endif()
endfunction()

# sinew_umbrella(ROOMS): sinew::sinew, which brings all of them, with <sinew/sinew.h>.
function(sinew_umbrella)
  add_library(sinew_all INTERFACE)
  add_library(sinew::sinew ALIAS sinew_all)
  set_target_properties(sinew_all PROPERTIES EXPORT_NAME sinew)
  list(TRANSFORM ARGN PREPEND sinew_ OUTPUT_VARIABLE rooms)
  target_link_libraries(sinew_all INTERFACE ${rooms})
  install(TARGETS sinew_all EXPORT sinew COMPONENT libsinew-dev)
  install(FILES lib/sinew/sinew.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/sinew COMPONENT libsinew-dev)
  add_custom_target(sinew_all_rooms DEPENDS ${rooms})
endfunction()

function(sinew_install_package)
  include(CMakePackageConfigHelpers)
  set(place ${CMAKE_INSTALL_LIBDIR}/cmake/sinew)
  install(EXPORT sinew NAMESPACE sinew:: DESTINATION ${place} FILE sinew-targets.cmake
    COMPONENT libsinew-dev)
  configure_package_config_file(lib/sinew-config.cmake.in ${PROJECT_BINARY_DIR}/sinew-config.cmake
    INSTALL_DESTINATION ${place})
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/sinew-config-version.cmake
    COMPATIBILITY SameMinorVersion)
  install(FILES ${PROJECT_BINARY_DIR}/sinew-config.cmake
    ${PROJECT_BINARY_DIR}/sinew-config-version.cmake DESTINATION ${place}
    COMPONENT libsinew-dev)
endfunction()

# The target `api`: pages of the library's headers in build/api, where Doxygen is there. The comment at the top of
# a header becomes that of its file.
function(sinew_api_pages)
  sinew_optional(DOXYGEN WHAT "the pages of the library's headers (target api)" PACKAGES doxygen
    FIND "find_package(Doxygen REQUIRED)")
  if(NOT SINEW_HAS_DOXYGEN)
    return()
  endif()
  find_package(Doxygen REQUIRED)
  set(DOXYGEN_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/api)
  set(DOXYGEN_HTML_OUTPUT .)
  set(DOXYGEN_STRIP_FROM_PATH ${PROJECT_SOURCE_DIR}/lib)
  set(DOXYGEN_STRIP_FROM_INC_PATH ${PROJECT_SOURCE_DIR}/lib)
  set(DOXYGEN_FILE_PATTERNS *.h)
  set(DOXYGEN_INPUT_FILTER [[sed -e '1s#^//.*#/// @file#' -e '2,/^.pragma once/s#^//#///#']])
  set(DOXYGEN_EXTRACT_ALL YES)
  set(DOXYGEN_JAVADOC_AUTOBRIEF YES)
  set(DOXYGEN_SORT_MEMBER_DOCS NO)
  set(DOXYGEN_WARN_AS_ERROR FAIL_ON_WARNINGS)
  doxygen_add_docs(api ${PROJECT_SOURCE_DIR}/lib COMMENT "pages of the library's headers: build/api/index.html")
endfunction()
