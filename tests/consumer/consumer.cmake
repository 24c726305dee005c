# What a user does with a project of this folder, from a copy of it:
#   cmake -D SOURCE=FOLDER -D WORK=FOLDER -D CXX=COMPILER -D GENERATOR=NAME -D RUN=COMMAND
#         [-D OPTIONS=LIST] [-D EDIT=MODEL] -P consumer.cmake
# configures, builds and runs.  With EDIT, also checks that the emitted header follows the model.
cmake_minimum_required(VERSION 3.22)

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output
                  ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    string(REPLACE ";" " " command "${ARGN}")
    message(FATAL_ERROR "${command}\n${output}\nresult ${result}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

function(expect_build_to_emit expected)
  run(${CMAKE_COMMAND} --build ${WORK}/build -j 2)
  set(found FALSE)
  if(output MATCHES "Emitting ${EDIT}.hpp")
    set(found TRUE)
  endif()
  if(NOT found STREQUAL expected)
    message(FATAL_ERROR "${EDIT}.hpp emitted: ${found}, expected ${expected}\n${output}")
  endif()
endfunction()

if(DEFINED EDIT)
  file(REMOVE_RECURSE ${WORK})  # an edit may have been left by a run that failed
endif()
file(COPY ${SOURCE}/ DESTINATION ${WORK}/project)
run(${CMAKE_COMMAND} -S ${WORK}/project -B ${WORK}/build -G ${GENERATOR}
    -D CMAKE_BUILD_TYPE=Release -D CMAKE_CXX_COMPILER=${CXX} ${OPTIONS})
run(${CMAKE_COMMAND} --build ${WORK}/build -j 2)
run(${WORK}/build/${RUN})
message("${output}")

if(DEFINED EDIT)
  expect_build_to_emit(FALSE)
  # Another strength of gravity: in the header and in what the program prints.
  set(model ${WORK}/project/${EDIT}.ham)
  file(READ ${model} text)
  string(REPLACE "0.03" "0.02" changed "${text}")
  file(WRITE ${model} "${changed}")
  expect_build_to_emit(TRUE)
  run(${WORK}/build/${RUN})
  if(NOT output MATCHES "eps 0.02")
    message(FATAL_ERROR "the edited model did not reach the program: ${output}")
  endif()
  # A wrong model stops the build and points at the line.
  string(REPLACE "cos(q)" "cos(r)" wrong "${text}")
  file(WRITE ${model} "${wrong}")
  execute_process(COMMAND ${CMAKE_COMMAND} --build ${WORK}/build RESULT_VARIABLE result
                  OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(result EQUAL 0 OR NOT output MATCHES "${EDIT}.ham:[0-9]+:[0-9]+: error: unknown name 'r'")
    message(FATAL_ERROR "a wrong model: result ${result}\n${output}")
  endif()
  file(WRITE ${model} "${text}")
  expect_build_to_emit(TRUE)
  expect_build_to_emit(FALSE)
endif()
