# One static library a folder of src/ with its subfolders. Sources are globbed, so a new file needs no list to be edited.

# the same objects go into the program and into libraries, so they are position-independent; hidden symbols that nobody can
# interpose keep that from costing calls and inlining
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)

add_library(sumogamma_options INTERFACE)
# -ffp-contract=off: the same bits with and without FMA hardware (house rule: determinism)
target_compile_options(sumogamma_options INTERFACE -ffp-contract=off -Wall -Wextra -Wpedantic
  -Wconversion -Wshadow -Wold-style-cast -Wnon-virtual-dtor -Woverloaded-virtual -Wdouble-promotion
  -fno-semantic-interposition)
if(SUMOGAMMA_WARNINGS_AS_ERRORS)
  target_compile_options(sumogamma_options INTERFACE -Werror)
endif()
if(SUMOGAMMA_SANITIZE)
  target_compile_options(sumogamma_options INTERFACE -fsanitize=${SUMOGAMMA_SANITIZE}
    -fno-omit-frame-pointer -fno-sanitize-recover=undefined)
  target_link_options(sumogamma_options INTERFACE -fsanitize=${SUMOGAMMA_SANITIZE})
endif()
target_include_directories(sumogamma_options INTERFACE ${PROJECT_SOURCE_DIR}/src)
target_link_libraries(sumogamma_options INTERFACE Eigen3::Eigen Threads::Threads)

option(SUMOGAMMA_PRECOMPILED_HEADERS "Parse what most sources include once" ON)
if(SUMOGAMMA_PRECOMPILED_HEADERS AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  # g++ 12 forgets that a precompiled header is the system's: it warns of libstdc++'s own moves of short strings
  target_compile_options(sumogamma_options INTERFACE -Wno-array-bounds -Wno-restrict
    -Wno-stringop-overflow -Wno-stringop-overread)
endif()
set(SUMOGAMMA_COMMON_HEADERS <algorithm> <array> <charconv> <chrono> <cmath> <filesystem> <fstream> <functional> <limits>
  <map> <memory> <numeric> <optional> <set> <span> <sstream> <string> <string_view> <unordered_map> <vector>
  <Eigen/Core> <fmt/format.h>)
# sumogamma_precompile(TARGET KIND [HEADER...]): the first target of a kind (same flags) precompiles the common headers and
# those named here, the others take them from it. They hide what a source forgot to include, so clang's presets go without.
function(sumogamma_precompile target kind)
  if(NOT SUMOGAMMA_PRECOMPILED_HEADERS)
    return()
  endif()
  get_property(owner GLOBAL PROPERTY SUMOGAMMA_PRECOMPILED_${kind})
  if(owner)
    target_precompile_headers(${target} REUSE_FROM ${owner})
  else()
    target_precompile_headers(${target} PRIVATE ${SUMOGAMMA_COMMON_HEADERS} ${ARGN})
    set_property(GLOBAL PROPERTY SUMOGAMMA_PRECOMPILED_${kind} ${target})
  endif()
endfunction()

# sumogamma_module(NAME [DEPENDS MODULE...]): src/NAME/**/*.cpp becomes sumogamma_NAME. External libraries of a
# module stand in cmake/dependencies.cmake as SUMOGAMMA_LIBS_<NAME>.
function(sumogamma_module name)
  cmake_parse_arguments(ARG "" "" "DEPENDS" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${name}/*.cpp)
  set_property(GLOBAL APPEND PROPERTY SUMOGAMMA_MODULES ${name})
  list(TRANSFORM ARG_DEPENDS PREPEND sumogamma_)
  if(sources)
    add_library(sumogamma_${name} STATIC ${sources})
    target_link_libraries(sumogamma_${name} PUBLIC sumogamma_options ${ARG_DEPENDS} ${SUMOGAMMA_LIBS_${name}})
    sumogamma_precompile(sumogamma_${name} modules)
  else()
    add_library(sumogamma_${name} INTERFACE)
    target_link_libraries(sumogamma_${name} INTERFACE sumogamma_options ${ARG_DEPENDS} ${SUMOGAMMA_LIBS_${name}})
  endif()
endfunction()

function(sumogamma_program target folder)
  cmake_parse_arguments(ARG "" "" "DEPENDS" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${folder}/*.cpp)
  list(TRANSFORM ARG_DEPENDS PREPEND sumogamma_)
  add_executable(${target} ${sources})
  target_link_libraries(${target} PRIVATE sumogamma_options ${ARG_DEPENDS} ${SUMOGAMMA_LIBS_${folder}})
endfunction()

# sumogamma_loadable(TARGET MODULE SOURCE WITH FILE... LIBRARIES LIBRARY...): a file of src/MODULE leaves its library and
# becomes TARGET.so beside the program, which the library opens by itself. It has copies of its own of those files of src/
# that it needs from the library which opens it, and of what it takes from libraries below that.
function(sumogamma_loadable target module source)
  cmake_parse_arguments(ARG "" "" "WITH;LIBRARIES" ${ARGN})
  set(own ${PROJECT_SOURCE_DIR}/src/${module}/${source})
  get_target_property(sources sumogamma_${module} SOURCES)
  list(REMOVE_ITEM sources ${own})
  set_target_properties(sumogamma_${module} PROPERTIES SOURCES "${sources}")
  list(TRANSFORM ARG_WITH PREPEND ${PROJECT_SOURCE_DIR}/src/)
  add_library(${target} MODULE ${own} ${ARG_WITH})
  set_target_properties(${target} PROPERTIES PREFIX "")
  target_link_libraries(${target} PRIVATE sumogamma_options ${ARG_LIBRARIES})
  add_dependencies(sumogamma_${module} ${target})
endfunction()
