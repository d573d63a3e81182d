# Headers of other people that nearly every file of a layer reads, parsed once instead of some hundred times. Only headers from outside: an own one that is
# missing still fails. The presets release and dev build without, so that a forgotten standard header fails there.
#   deltaz_precompile_headers(NAME LIBRARIES library... HEADERS header...)   what is parsed, with the directory's options
#   deltaz_use_precompiled_headers(TARGET NAME)                              a target with the same options and definitions
# Both do nothing unless DELTAZ_PRECOMPILED_HEADERS is on.
set(DELTAZ_STANDARD_HEADERS
    <algorithm> <array> <bit> <cmath> <cstdint> <functional> <limits> <map> <memory> <numbers> <optional> <random> <set> <span> <string> <string_view> <utility>
    <variant> <vector>)

function(deltaz_precompile_headers name)
  cmake_parse_arguments(ARG "" "" "LIBRARIES;HEADERS" ${ARGN})
  if(NOT DELTAZ_PRECOMPILED_HEADERS)
    return()
  endif()
  file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp CONTENT "")
  add_library(${name} OBJECT ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
  target_link_libraries(${name} PRIVATE deltaz_options ${ARG_LIBRARIES})
  target_precompile_headers(${name} PRIVATE ${DELTAZ_STANDARD_HEADERS} ${ARG_HEADERS})
endfunction()

function(deltaz_use_precompiled_headers target name)
  if(DELTAZ_PRECOMPILED_HEADERS)
    target_precompile_headers(${target} REUSE_FROM ${name})
    # GCC's garbage collector goes through all that the header made, each time; a gigabyte is enough to need it hardly ever (about a tenth less processor time).
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
      target_compile_options(${target} PRIVATE --param=ggc-min-heapsize=1048576)
    endif()
    # GCC 12 takes what it inlines from precompiled headers for code of ours, and warns of copies of strings there that are sound (as with -Wrestrict). The
    # preset dev builds without these headers and with the warnings.
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
      target_compile_options(${target} PRIVATE -Wno-array-bounds -Wno-stringop-overflow)
    endif()
  endif()
endfunction()
