# Compiles load/orbit.cpp with what pkg-config says of the installed hamgen, and runs it.
set(ENV{PKG_CONFIG_PATH} ${DIRECTORY})
execute_process(COMMAND ${PKG_CONFIG} --cflags --libs hamgen OUTPUT_VARIABLE flags
                OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
separate_arguments(flags UNIX_COMMAND "${flags}")
file(MAKE_DIRECTORY ${WORK})
execute_process(COMMAND ${CXX} -std=c++20 ${SOURCE}/orbit.cpp ${flags} -o ${WORK}/orbit
                COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${WORK}/orbit ${MODEL} COMMAND_ERROR_IS_FATAL ANY
                OUTPUT_VARIABLE printed)
# It prints what the page shows, but for the rounding of an energy.
file(READ ${PAGE} page)
foreach(text page printed)
  string(REGEX REPLACE "energy error [^\n]*" "" ${text} "${${text}}")
endforeach()
string(FIND "${page}" "\n${printed}```" at)
if(at EQUAL -1)
  message(FATAL_ERROR "${PAGE} does not show\n${printed}")
endif()
