#[[
hamgen_generate(TARGET target MODEL model.ham
                [SCHEME name] [ALPHA x] [BETA x] [GAMMA x] [ORDER n]
                [GAUGE locally-exact or C] [REFERENCE NAME=VALUE,...]
                [SOLVER name] [SCALAR type] [FOLD parameter...] [SIZES NAME=N...]
                [SCENE name] [SET NAME=VALUE...] [INITIAL NAME=VALUE...] [OBSERVE list]
                [WHOLE] [KEEP name...] [PLAIN_SUMS] [TANGENT] [EVENTS] [WATCH_MODIFIED k]
                [REQUIRE list] [FORMAT cpp-header, c-header or cpp-plugin]
                [NAMESPACE name] [SUPPORT own or shared] [BATCH w] [MATH own or libm] [PREFIX folder])

Emits the integrator of a Hamiltonian as a header when the target is built, and again whenever the
model or hamgen changes.  The header is named after the model and found by the target and by all
that link to it:

  add_executable(orbit main.cpp)
  hamgen_generate(TARGET orbit MODEL kepler.ham)      # in main.cpp: #include "kepler.hpp"

TARGET     an executable or library of the project, INTERFACE libraries included
MODEL      relative to the current source directory
PREFIX     emits into a folder, #include "folder/kepler.hpp": for several methods of one model,
           which share its State
REQUIRE    properties that must be proved, "symplectic,order:2": else the build fails
FORMAT     c-header emits NAME.h; a cpp-plugin, NAME.plugin.cpp, becomes a source of the target
the rest   as the options of `hamgen generate`; a list for several degrees of freedom is one value,
           ALPHA "1/2,1/3".  SIZES and SET are both --set

Nothing is linked, except libquadmath for SCALAR quad and libm for a c-header.  A header whose plan needs Eigen (see
`hamgen show --stage plan`) expects Eigen3::Eigen from the project.
]]
# Where plugin.h is: beside this file in the sources, else where the package says.
if(EXISTS ${CMAKE_CURRENT_LIST_DIR}/../plugin.h)
  get_filename_component(HAMGEN_PLUGIN_INCLUDE_DIRECTORY ${CMAKE_CURRENT_LIST_DIR}/.. ABSOLUTE
                         CACHE)
  mark_as_advanced(HAMGEN_PLUGIN_INCLUDE_DIRECTORY)
endif()

function(hamgen_generate)
  set(one_value TARGET MODEL SCHEME ALPHA BETA GAMMA ORDER GAUGE REFERENCE SOLVER SCALAR NAMESPACE SUPPORT
                SCENE OBSERVE WATCH_MODIFIED REQUIRE FORMAT BATCH MATH PREFIX)
  set(flags PLAIN_SUMS TANGENT EVENTS WHOLE)
  cmake_parse_arguments(PARSE_ARGV 0 arg "${flags}" "${one_value}" "FOLD;SIZES;SET;INITIAL;KEEP")
  if(arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "hamgen_generate: unexpected ${arg_UNPARSED_ARGUMENTS}")
  endif()
  if(arg_KEYWORDS_MISSING_VALUES)
    message(FATAL_ERROR "hamgen_generate: no value for ${arg_KEYWORDS_MISSING_VALUES}")
  endif()
  foreach(required TARGET MODEL)
    if(NOT arg_${required})
      message(FATAL_ERROR "hamgen_generate: ${required} is missing")
    endif()
  endforeach()
  if(NOT TARGET ${arg_TARGET})
    message(FATAL_ERROR "hamgen_generate: there is no target '${arg_TARGET}'; add it first")
  endif()
  get_filename_component(model ${arg_MODEL} ABSOLUTE)
  if(NOT EXISTS ${model})
    message(FATAL_ERROR "hamgen_generate: there is no file ${model}")
  endif()

  # As in a library's own include folder: the headers lie below what goes into the include path.
  set(include_directory ${CMAKE_CURRENT_BINARY_DIR}/hamgen/${arg_TARGET})
  set(output_directory ${include_directory})
  if(arg_PREFIX)
    string(APPEND output_directory /${arg_PREFIX})
  endif()
  get_filename_component(name ${model} NAME_WLE)
  if(NOT arg_FORMAT)
    set(arg_FORMAT cpp-header)
  elseif(arg_FORMAT MATCHES "^c(pp)?$")
    string(APPEND arg_FORMAT -header)
  endif()
  if(arg_FORMAT STREQUAL cpp-header)
    set(ending .hpp)
  elseif(arg_FORMAT STREQUAL c-header)
    set(ending .h)
  elseif(arg_FORMAT STREQUAL cpp-plugin)
    set(ending .plugin.cpp)
  else()
    message(FATAL_ERROR "hamgen_generate: FORMAT is cpp-header, c-header or cpp-plugin, "
                        "not ${arg_FORMAT}")
  endif()
  set(header ${output_directory}/${name}${ending})
  get_property(headers TARGET ${arg_TARGET} PROPERTY HAMGEN_HEADERS)
  if(header IN_LIST headers)
    message(FATAL_ERROR "hamgen_generate: ${name}${ending} is emitted twice for ${arg_TARGET}; "
                        "give one of them a PREFIX")
  endif()
  set_property(TARGET ${arg_TARGET} APPEND PROPERTY HAMGEN_HEADERS ${header})

  set(options)
  foreach(option SCHEME ALPHA BETA GAMMA ORDER GAUGE REFERENCE SOLVER SCALAR NAMESPACE
                 SUPPORT SCENE OBSERVE WATCH_MODIFIED REQUIRE BATCH MATH)
    if(DEFINED arg_${option})
      string(TOLOWER ${option} flag)
      string(REPLACE _ - flag ${flag})
      list(APPEND options --${flag}=${arg_${option}})
    endif()
  endforeach()
  foreach(option IN LISTS flags)
    if(arg_${option})
      string(TOLOWER ${option} flag)
      string(REPLACE _ - flag ${flag})
      list(APPEND options --${flag})
    endif()
  endforeach()
  foreach(option FOLD KEEP SET INITIAL)
    string(TOLOWER ${option} flag)
    foreach(value IN LISTS arg_${option})
      list(APPEND options --${flag}=${value})
    endforeach()
  endforeach()
  foreach(size IN LISTS arg_SIZES)
    list(APPEND options --set=${size})
  endforeach()

  # The header quotes this command: a relative path keeps its text the same on every machine.
  file(RELATIVE_PATH typed_model ${CMAKE_CURRENT_SOURCE_DIR} ${model})
  # hamgen leaves an equal header untouched, so that nothing is compiled anew; the stamp says that
  # it is up to date.
  set(stamp ${header}.stamp)
  add_custom_command(
    OUTPUT ${stamp}
    BYPRODUCTS ${header}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${output_directory}
    COMMAND hamgen::hamgen generate ${typed_model} ${options} --format ${arg_FORMAT}
            -o ${output_directory}
    COMMAND ${CMAKE_COMMAND} -E touch ${stamp}
    DEPENDS ${model} hamgen::hamgen
    WORKING_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}
    COMMENT "Emitting ${name}${ending} from ${arg_MODEL}"
    VERBATIM)
  # A target of its own: the header is made first also where the target has no sources (INTERFACE)
  # or was added in another folder.
  string(MAKE_C_IDENTIFIER "${arg_PREFIX}_${name}" suffix)
  set(emission ${arg_TARGET}_hamgen_${suffix})
  add_custom_target(${emission} DEPENDS ${stamp})
  add_dependencies(${arg_TARGET} ${emission})

  get_target_property(type ${arg_TARGET} TYPE)
  if(type STREQUAL INTERFACE_LIBRARY)
    set(scope INTERFACE)
  else()
    set(scope PUBLIC)
  endif()
  target_include_directories(${arg_TARGET} ${scope} $<BUILD_INTERFACE:${include_directory}>)
  if(arg_FORMAT STREQUAL cpp-plugin)
    if(type STREQUAL INTERFACE_LIBRARY)
      message(FATAL_ERROR "hamgen_generate: ${arg_TARGET} is an INTERFACE library and has no sources: "
                          "a cpp-plugin is one")
    endif()
    target_sources(${arg_TARGET} PRIVATE ${header})
    set_source_files_properties(${header} PROPERTIES GENERATED ON)
    target_include_directories(${arg_TARGET} PRIVATE ${HAMGEN_PLUGIN_INCLUDE_DIRECTORY})
  endif()
  if(arg_FORMAT STREQUAL c-header)
    target_link_libraries(${arg_TARGET} ${scope} m)  # a program in C has it not by itself
  else()
    target_compile_features(${arg_TARGET} ${scope} cxx_std_17)
  endif()
  if(arg_SCALAR STREQUAL quad)
    target_link_libraries(${arg_TARGET} ${scope} quadmath)
  endif()
endfunction()
