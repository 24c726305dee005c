#[[
hamgen_generate(TARGET target MODEL model.ham
                [SCHEME name] [ALPHA x] [BETA x] [GAMMA x] [ORDER n]
                [GAUGE locally-exact or C] [REFERENCE NAME=VALUE,...]
                [SOLVER name] [SCALAR type] [FOLD parameter...] [SIZES NAME=N...]
                [SCENE name] [OBSERVE list] [KEEP name...] [PLAIN_SUMS]
                [NAMESPACE name] [SUPPORT own or shared] [PREFIX folder])

Emits the integrator of a Hamiltonian as a header when the target is built, and again whenever the
model or hamgen changes.  The header is named after the model and found by the target and by all
that link to it:

  add_executable(orbit main.cpp)
  hamgen_generate(TARGET orbit MODEL kepler.ham)      # in main.cpp: #include "kepler.hpp"

TARGET     an executable or library of the project, INTERFACE libraries included
MODEL      relative to the current source directory
PREFIX     emits into a folder, #include "folder/kepler.hpp": for several methods of one model,
           which share its State
the rest   as the options of `hamgen generate`; a list for several degrees of freedom is one value,
           ALPHA "1/2,1/3"

Nothing is linked, except libquadmath for SCALAR quad.  A header whose plan needs Eigen (see
`hamgen show --stage plan`) expects Eigen3::Eigen from the project.
]]
function(hamgen_generate)
  set(one_value TARGET MODEL SCHEME ALPHA BETA GAMMA ORDER GAUGE REFERENCE SOLVER SCALAR NAMESPACE SUPPORT
                SCENE OBSERVE PREFIX)
  cmake_parse_arguments(PARSE_ARGV 0 arg "PLAIN_SUMS" "${one_value}" "FOLD;SIZES;KEEP")
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
  set(header ${output_directory}/${name}.hpp)
  get_property(headers TARGET ${arg_TARGET} PROPERTY HAMGEN_HEADERS)
  if(header IN_LIST headers)
    message(FATAL_ERROR "hamgen_generate: ${name}.hpp is emitted twice for ${arg_TARGET}; "
                        "give one of them a PREFIX")
  endif()
  set_property(TARGET ${arg_TARGET} APPEND PROPERTY HAMGEN_HEADERS ${header})

  set(options)
  foreach(option SCHEME ALPHA BETA GAMMA ORDER GAUGE REFERENCE SOLVER SCALAR NAMESPACE
                 SUPPORT SCENE OBSERVE)
    if(DEFINED arg_${option})
      string(TOLOWER ${option} flag)
      list(APPEND options --${flag}=${arg_${option}})
    endif()
  endforeach()
  if(arg_PLAIN_SUMS)
    list(APPEND options --plain-sums)
  endif()
  foreach(parameter IN LISTS arg_FOLD)
    list(APPEND options --fold=${parameter})
  endforeach()
  foreach(kept IN LISTS arg_KEEP)
    list(APPEND options --keep=${kept})
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
    COMMAND hamgen::hamgen generate ${typed_model} ${options} --format cpp-header
            -o ${output_directory}
    COMMAND ${CMAKE_COMMAND} -E touch ${stamp}
    DEPENDS ${model} hamgen::hamgen
    WORKING_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}
    COMMENT "Emitting ${name}.hpp from ${arg_MODEL}"
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
  target_compile_features(${arg_TARGET} ${scope} cxx_std_17)
  if(arg_SCALAR STREQUAL quad)
    target_link_libraries(${arg_TARGET} ${scope} quadmath)
  endif()
endfunction()
