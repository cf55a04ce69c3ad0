# tumble_target(TARGET): the language level, warnings and instrumentation that every target of the project is built with.
# Nothing is set globally, so that a project which embeds this one keeps its own flags.
include_guard()

option(TUMBLE_EIGEN_NAN "Initialise Eigen matrices to NaN, so that use before assignment shows" OFF)
option(TUMBLE_WARNINGS_AS_ERRORS "Warnings fail the build" OFF)
option(TUMBLE_PRECOMPILE "Parse the headers that nearly every file includes once per library, and once for all tests" OFF)
set(TUMBLE_SANITIZE "" CACHE STRING "Sanitizers, comma separated: address,undefined or thread")

function(tumble_target target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF POSITION_INDEPENDENT_CODE ON)
  # -Wrestrict of GCC 12 cries wolf at every concatenation of strings (GCC bug 105329)
  # no contraction into fused multiply-add: the same source gives the same bits on every x86-64
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual -Wno-restrict -ffp-contract=off
    $<$<CONFIG:Release>:-O3>)
  if(TUMBLE_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(TUMBLE_EIGEN_NAN)
    target_compile_definitions(${target} PUBLIC EIGEN_INITIALIZE_MATRICES_BY_NAN)
  endif()
  if(TUMBLE_SANITIZE)
    target_compile_options(${target} PUBLIC -fsanitize=${TUMBLE_SANITIZE} -fno-omit-frame-pointer)
    target_link_options(${target} PUBLIC -fsanitize=${TUMBLE_SANITIZE})
  endif()
endfunction()

# Without the first ccache keeps nothing. The others: GCC 12 forgets that what it precompiled were system headers, and
# warns of std::string there.
function(tumble_precompiled_flags target)
  target_compile_options(${target} PRIVATE -fpch-preprocess -Wno-array-bounds -Wno-stringop-overflow
    -Wno-stringop-overread)
endfunction()

# tumble_precompile(TARGET HEADER...): the files of TARGET begin with what these headers left, parsed once. Saves time
# alone: every file includes what it uses, which the debug build, without this, shows.
function(tumble_precompile target)
  if(NOT TUMBLE_PRECOMPILE)
    return()
  endif()
  target_precompile_headers(${target} PRIVATE ${ARGN})
  tumble_precompiled_flags(${target})
endfunction()

# tumble_precompile_as(TARGET OTHER): with the headers that were precompiled for OTHER, which has the same flags.
function(tumble_precompile_as target other)
  if(NOT TUMBLE_PRECOMPILE)
    return()
  endif()
  target_precompile_headers(${target} REUSE_FROM ${other})
  tumble_precompiled_flags(${target})
endfunction()
