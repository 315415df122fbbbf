# Language, warnings and the numeric contract, for every target of the tree.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -g1")

option(QUADRILLE_WERROR "Warnings are errors" ON)
set(QUADRILLE_SANITIZE "" CACHE STRING "Value of -fsanitize=, empty for none")

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_NOHASHDIR=1 CCACHE_BASEDIR=${CMAKE_SOURCE_DIR} ${CCACHE_PROGRAM})
endif()

# Determinism: one baseline instruction set, no contraction, no fast-math (docs/architecture.md, numeric contract).
add_compile_options(-march=x86-64-v3 -ffp-contract=off -fno-math-errno)

add_library(quadrille_warnings INTERFACE)
target_compile_options(quadrille_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion $<$<BOOL:${QUADRILLE_WERROR}>:-Werror>)
# GCC 12's data-flow warnings fire inside fmt and the standard library once their code is inlined at -O3; the sanitizers and clang-tidy look for the same mistakes.
target_compile_options(quadrille_warnings INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overflow -Wno-array-bounds -Wno-restrict>)

if(QUADRILLE_SANITIZE)
  # vptr needs the type information of every base class, which Debian's glslang and SPIRV-Tools are built without.
  add_compile_options(-fsanitize=${QUADRILLE_SANITIZE} -fno-sanitize=vptr -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${QUADRILLE_SANITIZE})
endif()

# quadrille_library(NAME SOURCES...): a static library of the tree, included as "folder/file.h" from the root.
function(quadrille_library name)
  add_library(${name} STATIC ${ARGN})
  target_include_directories(${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:include/quadrille>)
  target_compile_features(${name} PUBLIC cxx_std_20)
  # What includes the headers computes as the library does.
  target_compile_options(${name} INTERFACE $<INSTALL_INTERFACE:-march=x86-64-v3> $<INSTALL_INTERFACE:-ffp-contract=off>)
  target_link_libraries(${name} PRIVATE quadrille_warnings)
  set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
endfunction()
