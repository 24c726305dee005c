# cmake -D PAGE=FILE -D WORK=FOLDER -D FILES=LIST -D CXX=COMPILER -D GENERATOR=NAME -D PREFIX=FOLDER
#       -P page.cmake
# builds the project that a page shows in its block marked cmake, with these files beside it.
file(READ ${PAGE} page)
string(REGEX MATCH "```cmake\n([^`]*)```" block "${page}")
if(NOT block)
  message(FATAL_ERROR "${PAGE} shows no project")
endif()
file(REMOVE_RECURSE ${WORK})
file(WRITE ${WORK}/CMakeLists.txt
  "cmake_minimum_required(VERSION 3.22)\nproject(page LANGUAGES CXX)\n${CMAKE_MATCH_1}")
file(COPY ${FILES} DESTINATION ${WORK})
if(NOT EXISTS ${WORK}/orbit.cpp)
  file(WRITE ${WORK}/main.cpp "#include \"kepler.hpp\"\nint main() { kepler::State z{}; return z.q1 != 0.0; }\n")
endif()
foreach(command "-S;${WORK};-B;${WORK}/build;-G;${GENERATOR};-DCMAKE_CXX_COMPILER=${CXX};-DCMAKE_PREFIX_PATH=${PREFIX}"
    "--build;${WORK}/build")
  execute_process(COMMAND ${CMAKE_COMMAND} ${command} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
if(NOT EXISTS ${WORK}/build/orbit)
  message(FATAL_ERROR "${PAGE}: no program was built")
endif()
