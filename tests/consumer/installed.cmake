# cmake -DPREFIX=... -DLIBDIR=... -DSOURCE=... -P installed.cmake: what lies in the prefix is what is
# listed here, and a header includes none that is not installed.
file(GLOB_RECURSE found RELATIVE ${PREFIX} ${PREFIX}/*)
list(FILTER found EXCLUDE REGEX "^bin/hamgen-mpi$")  # where MPI is
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
  share/zsh/site-functions/_hamgen share/doc/hamgen/README.md share/doc/hamgen/LICENSE)
file(GLOB models RELATIVE ${SOURCE} ${SOURCE}/hamiltonians/*)
list(TRANSFORM models PREPEND share/hamgen/)
file(GLOB_RECURSE pages RELATIVE ${SOURCE}/docs ${SOURCE}/docs/*.md ${SOURCE}/docs/*.svg
  ${SOURCE}/docs/*.png ${SOURCE}/docs/*.cff ${SOURCE}/docs/*.c ${SOURCE}/docs/*.py
  ${SOURCE}/docs/*.ham)
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
endforeach()
