# How every piperun target is built: one function for a floor's library, one for its table of kinds.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()
find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()

include(GNUInstallDirs)

# Warnings and reproducible floating point. Contraction (FMA) and fast-math change bits between compilers; that nobody
# reads errno or traps changes none, and lets square roots and choices be single instructions.
add_library(piperun_flags INTERFACE)
target_compile_options(piperun_flags INTERFACE -Wall -Wextra -Wconversion -ffp-contract=off -fno-math-errno
                                               -fno-trapping-math)
if(CMAKE_CXX_COMPILER_ID MATCHES Clang)
  target_compile_options(piperun_flags INTERFACE -Wno-sign-conversion)  # as g++ reads -Wconversion
else()
  target_compile_options(piperun_flags INTERFACE -Wno-restrict)  # g++ 12 warns of std::string itself (PR 105651)
endif()
if(PIPERUN_WERROR)
  target_compile_options(piperun_flags INTERFACE -Werror)
endif()
if(PIPERUN_SANITIZE)
  target_compile_options(piperun_flags INTERFACE
    -fsanitize=${PIPERUN_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(piperun_flags INTERFACE -fsanitize=${PIPERUN_SANITIZE})
  if(PIPERUN_SANITIZE MATCHES undefined)
    # These four double the time Eigen takes to compile; the address sanitizer sees what they would see.
    target_compile_options(piperun_flags INTERFACE -fno-sanitize=null,alignment,object-size,vptr)
  endif()
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    # Its manual: false ones with sanitizers; and it inlines one half of a replaced operator new and delete.
    target_compile_options(piperun_flags INTERFACE -Wno-maybe-uninitialized -Wno-mismatched-new-delete)
  endif()
endif()

# The hot path crosses files and floors. g++ lays what it needs for that beside the machine code of the floors'
# libraries; piperun_optimise_whole(TARGET) makes it use that for the programs that users run and time. The bits stay.
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_BUILD_TYPE STREQUAL Release)
  set(PIPERUN_WHOLE_PROGRAM -flto=auto -ffat-lto-objects)
endif()
function(piperun_optimise_whole target)
  if(PIPERUN_WHOLE_PROGRAM)
    target_link_options(${target} PRIVATE ${PIPERUN_WHOLE_PROGRAM})
  endif()
endfunction()

# piperun_link_plainly(TARGET): from the machine code alone, which is quicker.
function(piperun_link_plainly target)
  if(PIPERUN_WHOLE_PROGRAM)
    target_link_options(${target} PRIVATE -fno-lto)
  endif()
endfunction()

# piperun_add_floor(NAME FOLDERS...): the static library piperun_NAME from every .cc of the given folders,
# with the headers beside them as its interface. Third parties are linked PRIVATE by the caller.
function(piperun_add_floor name)
  set(sources)
  foreach(folder IN LISTS ARGN)
    file(GLOB found CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*.cc)
    list(APPEND sources ${found})
  endforeach()
  add_library(piperun_${name} STATIC ${sources})
  add_library(piperun::${name} ALIAS piperun_${name})
  set_target_properties(piperun_${name} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  target_include_directories(piperun_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/piperun>)
  target_compile_features(piperun_${name} PUBLIC cxx_std_20)
  if(name MATCHES "^(base|sim|estimator)$")  # what steps at the rate of the physics and of the sensors
    target_compile_options(piperun_${name} PRIVATE ${PIPERUN_WHOLE_PROGRAM})
  endif()
  target_link_libraries(piperun_${name} PRIVATE $<BUILD_INTERFACE:piperun_flags>)
  set_property(GLOBAL APPEND PROPERTY PIPERUN_FLOORS ${name})
endfunction()

# piperun_add_kinds(FLOOR FOLDER TYPE HEADER FUNCTION): finds the kinds of one table. Every FOLDER/NAME.cc of
# the floor defines `TYPE piperun::FLOOR::FOLDER::NAME::Kind()`; the generated source defines
# `const std::vector<TYPE>& piperun::FLOOR::FUNCTION()` in alphabetical order. No list is kept by hand.
function(piperun_add_kinds floor folder type header function)
  file(GLOB files CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*.cc)
  list(SORT files)
  set(declarations "")
  set(entries "")
  foreach(file IN LISTS files)
    get_filename_component(kind ${file} NAME_WE)
    string(APPEND declarations "namespace ${folder}::${kind} { ${type} Kind(); }\n")
    string(APPEND entries "${folder}::${kind}::Kind(), ")
  endforeach()
  set(output ${CMAKE_CURRENT_BINARY_DIR}/${folder}_table.cc)
  file(GENERATE OUTPUT ${output} CONTENT
"#include \"${header}\"
namespace piperun::${floor} {
${declarations}
const std::vector<${type}>& ${function}() {
  static const std::vector<${type}> kinds{${entries}};
  return kinds;
}
}  // namespace piperun::${floor}
")
  target_sources(piperun_${floor} PRIVATE ${files} ${output})
endfunction()
