# Compilers spend most of their time on templates of other people that every file instantiates anew (CLI11, nlohmann-json, gtest, the standard library): with
# DELTAZ_JOIN_SOURCES tests and tools are compiled eight files at a time, and the whole build takes less than half the processor time. The libraries are not:
# what is tested is what is delivered. The presets release and dev compile every file by itself, so that a forgotten header fails there.
#   deltaz_join_sources()            targets that this directory and those below it make from here on
#   deltaz_compile_alone(FILE...)    files of this directory's targets that have names of their own in common with others, or would hide theirs
macro(deltaz_join_sources)
  if(DELTAZ_JOIN_SOURCES)
    set(CMAKE_UNITY_BUILD ON)
  endif()
endmacro()

function(deltaz_compile_alone)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()
