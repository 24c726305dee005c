# Builds hamgen from SOURCE in WORK with all of its optional libraries off, and runs what needs them.
set(off)
foreach(library ARB TBB HDF5 MPI)
  list(APPEND off -DHAMGEN_WITH_${library}=OFF)
endforeach()
execute_process(
  COMMAND ${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK} -G ${GENERATOR} ${off}
          -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_BUILD_TYPE=Release "-DCMAKE_CXX_FLAGS_RELEASE=${FLAGS}"
          -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER} -DHAMGEN_UNITY_BUILD=ON -DHAMGEN_TESTS=OFF
          -DHAMGEN_BENCHMARKS=OFF
  RESULT_VARIABLE result OUTPUT_VARIABLE configured ERROR_VARIABLE configured)
if(NOT result EQUAL 0 OR NOT configured MATCHES "hamgen-mpi is not built: libopenmpi-dev")
  message(FATAL_ERROR "configuring: ${result}\n${configured}")
endif()
execute_process(COMMAND ${CMAKE_COMMAND} --build ${WORK} --target hamgen RESULT_VARIABLE result
                OUTPUT_VARIABLE built ERROR_VARIABLE built)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "building: ${result}\n${built}")
endif()
foreach(program hamgen-mpi hamgen-whole)
  if(EXISTS ${WORK}/bin/${program})
    message(FATAL_ERROR "${program} is there without its libraries")
  endif()
endforeach()

# The command with these words ends with this status and says what matches.
function(expect status text)
  execute_process(COMMAND ${WORK}/bin/hamgen ${ARGN} WORKING_DIRECTORY ${WORK}
                  RESULT_VARIABLE result OUTPUT_VARIABLE said ERROR_VARIABLE said)
  if(NOT result EQUAL ${status} OR NOT said MATCHES "${text}")
    message(FATAL_ERROR "hamgen ${ARGN}: status ${result}, not ${status} with '${text}':\n${said}")
  endif()
endfunction()

set(model ${SOURCE}/hamiltonians/pendulum.ham)
expect(4 "libflint-arb-dev libflint-dev" certify ${model})
expect(4 "libflint-arb-dev libflint-dev" run ${model} --certify)
expect(2 "libtbb-dev" ensemble ${model} --over q=0:3:10 --steps 10 --threads 2 -o x.csv)
expect(2 "libhdf5-dev" ensemble ${model} --over q=0:3:10 --steps 10 -o x.h5)
# The rest is as ever: by one thread, which is said once.
expect(0 "one thread: built without oneTBB; the package libtbb-dev" ensemble ${model} --over q=0:3:10
       --steps 10 -o x.csv)
expect(0 "last state" run ${model} --steps 10)
