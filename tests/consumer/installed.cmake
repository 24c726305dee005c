# cmake -DPREFIX=... -DLIBDIR=... -DCXX=... -DSOURCE=... -P installed.cmake: what lies in the prefix is
# what is listed here, a header includes none that is not installed and compiles without a warning,
# and a page links to none.
cmake_minimum_required(VERSION 3.22)

file(GLOB_RECURSE found RELATIVE ${PREFIX} ${PREFIX}/*)
list(FILTER found EXCLUDE REGEX "^bin/hamgen-(mpi|whole)$")  # where MPI, Arb or HDF5 is
set(expected bin/hamgen
  include/hamgen/cache.hpp include/hamgen/compile.hpp include/hamgen/compiler.hpp
  include/hamgen/event.hpp include/hamgen/event_observer.hpp include/hamgen/integrator.hpp
  include/hamgen/judge.hpp include/hamgen/library.hpp include/hamgen/load.hpp
  include/hamgen/load_plugin.hpp include/hamgen/plugin.h include/hamgen/status.hpp
  include/hamgen/tool_error.hpp include/hamgen/trajectory.hpp include/hamgen/wide.hpp
  ${LIBDIR}/libhamgen_runtime.a ${LIBDIR}/pkgconfig/hamgen.pc
  ${LIBDIR}/cmake/hamgen/HamgenGenerate.cmake ${LIBDIR}/cmake/hamgen/hamgenConfig.cmake
  ${LIBDIR}/cmake/hamgen/hamgenConfigVersion.cmake
  ${LIBDIR}/cmake/hamgen/hamgenRuntimeTargets-release.cmake
  ${LIBDIR}/cmake/hamgen/hamgenRuntimeTargets.cmake
  ${LIBDIR}/cmake/hamgen/hamgenTargets-release.cmake ${LIBDIR}/cmake/hamgen/hamgenTargets.cmake
  share/bash-completion/completions/hamgen share/man/man1/hamgen.1
  share/zsh/site-functions/_hamgen share/doc/hamgen/README.md share/doc/hamgen/LICENSE
  share/doc/hamgen/benchmarks/README.md share/doc/hamgen/benchmarks/contract/README.md
  share/doc/hamgen/benchmarks/drift/README.md share/doc/hamgen/benchmarks/earlier/README.md
  share/doc/hamgen/benchmarks/rounding/README.md)
file(GLOB models RELATIVE ${SOURCE} ${SOURCE}/hamiltonians/*)
list(TRANSFORM models PREPEND share/doc/hamgen/)
file(GLOB_RECURSE pages RELATIVE ${SOURCE}/docs ${SOURCE}/docs/*.md ${SOURCE}/docs/*.svg
  ${SOURCE}/docs/*.png ${SOURCE}/docs/*.cff ${SOURCE}/docs/*.c ${SOURCE}/docs/*.py
  ${SOURCE}/docs/*.ham ${SOURCE}/docs/*.v)
list(TRANSFORM pages PREPEND share/doc/hamgen/docs/)
list(APPEND expected ${models} ${pages})

set(missing ${expected})
list(REMOVE_ITEM missing ${found})
set(more ${found})
list(REMOVE_ITEM more ${expected})
if(missing OR more)
  message(FATAL_ERROR "not installed: ${missing}\ninstalled besides: ${more}")
endif()

file(GLOB headers ${PREFIX}/include/hamgen/*)
foreach(header IN LISTS headers)
  file(STRINGS ${header} lines REGEX "^#include \"")
  foreach(line IN LISTS lines)
    string(REGEX REPLACE "^#include \"([^\"]*)\".*" "\\1" name ${line})
    if(NOT EXISTS ${PREFIX}/include/${name})
      message(FATAL_ERROR "${header} includes ${name}, which is not installed")
    endif()
  endforeach()
  list(APPEND included -include ${header})
endforeach()
execute_process(
  COMMAND ${CXX} -std=c++20 -fsyntax-only -x c++ ${included} /dev/null -I ${PREFIX}/include
          -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wshadow -Wold-style-cast
          -Wdouble-promotion -Werror
  RESULT_VARIABLE result ERROR_VARIABLE warnings)
if(NOT result EQUAL 0)
  message(SEND_ERROR "${warnings}")
endif()

# "](TARGET" and src="TARGET" of the pages, outside of their code.
file(GLOB_RECURSE pages ${PREFIX}/share/doc/hamgen/*.md)
string(ASCII 1 fence)
set(count 0)
foreach(page IN LISTS pages)
  file(READ ${page} text)
  string(REPLACE "```" "${fence}" text "${text}")
  string(REGEX REPLACE "${fence}[^${fence}]*${fence}" "" text "${text}")
  string(REGEX REPLACE "`[^`\n]*`" "" text "${text}")
  string(REPLACE "](" "src=\"" text "${text}")
  string(REGEX REPLACE "[];[]" "" text "${text}")  # which lists take for their own
  string(REGEX MATCHALL "src=\"[^)\" #]+" links "${text}")
  cmake_path(GET page PARENT_PATH folder)
  foreach(link IN LISTS links)
    string(REPLACE "src=\"" "" target "${link}")
    if(target MATCHES "^https?://")
      continue()
    endif()
    math(EXPR count "${count} + 1")
    cmake_path(ABSOLUTE_PATH target BASE_DIRECTORY ${folder} NORMALIZE OUTPUT_VARIABLE file)
    cmake_path(IS_PREFIX PREFIX ${file} inside)
    if(NOT inside OR NOT EXISTS ${file})
      message(SEND_ERROR "${page} links to ${target}, which is not installed")
    endif()
  endforeach()
endforeach()
if(count LESS 100)
  message(FATAL_ERROR "the pages have ${count} links: does this test find them?")
endif()
