# What compiles and links in less time and gives the same. The settings of ccache stand in its launcher.
function(tumble_accelerate target)
  if(NOT TUMBLE_ACCELERATE)
    return()
  endif()
  find_program(TUMBLE_CCACHE ccache)
  find_program(TUMBLE_MOLD mold)
  if(TUMBLE_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    set_target_properties(${target} PROPERTIES CXX_COMPILER_LAUNCHER
      "sh;${CMAKE_CURRENT_FUNCTION_LIST_DIR}/ccache_launcher;${TUMBLE_CCACHE};${CMAKE_SOURCE_DIR}")
  endif()
  if(TUMBLE_MOLD AND CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 12.1)
    target_link_options(${target} PRIVATE -fuse-ld=mold)
  endif()
endfunction()

# tumble_target(TARGET [LIGHT|COMPUTES]): the language level, warnings and instrumentation that every target of the project is
# built with. LIGHT: optimised lightly, for what spends no time itself (command line, pages, tests): it compiles in two
# thirds of the time, and gives the same bits. COMPUTES: what tests wait for; optimised fully with TUMBLE_LIGHT too.
# Nothing is set globally, so that a project which embeds this one keeps its own flags.
include_guard()

option(TUMBLE_EIGEN_NAN "Initialise Eigen matrices to NaN, so that use before assignment shows" OFF)
option(TUMBLE_WARNINGS "Ask the compiler for its warnings: who builds what others have read does without" ON)
option(TUMBLE_WARNINGS_AS_ERRORS "Warnings fail the build" OFF)
option(TUMBLE_PRECOMPILE "Parse the headers that nearly every file includes once per library, and once for all tests" OFF)
option(TUMBLE_LIGHT "Every target as LIGHT, fast to compile, but those that say COMPUTES" OFF)
option(TUMBLE_UNITY "Compile the sources of a target some at a time" OFF)
option(TUMBLE_ACCELERATE "Compile through ccache and link with mold, where they are there" OFF)
set(TUMBLE_SANITIZE "" CACHE STRING "Sanitizers, comma separated: address,undefined,fuzzer-no-link (Clang alone) or thread")

function(tumble_target target)
  cmake_parse_arguments(arg "LIGHT;COMPUTES" "" "" ${ARGN})
  if(TUMBLE_LIGHT AND NOT arg_COMPUTES)
    set(arg_LIGHT ON)
  endif()
  target_compile_features(${target} PUBLIC cxx_std_20)
  tumble_accelerate(${target})
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF POSITION_INDEPENDENT_CODE ON)
  if(TUMBLE_UNITY)  # what sources instantiate alike is instantiated once: no two of a target give one name to two things
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 8)
    if(arg_LIGHT)
      set_target_properties(${target} PROPERTIES UNITY_BUILD_BATCH_SIZE 16)
    endif()
    # what is private to a source looks to GCC as if it stood in a header
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  endif()
  # -Wrestrict of GCC 12 cries wolf at every concatenation of strings (GCC bug 105329)
  # no contraction into fused multiply-add: the same source gives the same bits on every x86-64
  target_compile_options(${target} PRIVATE
    $<$<BOOL:${TUMBLE_WARNINGS}>:-Wall -Wextra -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual>
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
    -ffp-contract=off
    $<$<CONFIG:Release>:$<IF:$<BOOL:${arg_LIGHT}>,-O1,-O3>>)
  # GCC collects its garbage beyond 128 MiB by itself, which costs sources of templates time and saves memory that is
  # there (`time` of their lines in compile_commands.json with and without it)
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=524288>)
  if(TUMBLE_WARNINGS_AS_ERRORS)
    # but where GCC takes Eigen's storage, which begins as it is, for a value that is read
    target_compile_options(${target} PRIVATE -Werror $<$<CXX_COMPILER_ID:GNU>:-Wno-error=maybe-uninitialized>)
  endif()
  if(TUMBLE_EIGEN_NAN)
    target_compile_definitions(${target} PUBLIC EIGEN_INITIALIZE_MATRICES_BY_NAN)
  endif()
  if(TUMBLE_SANITIZE)
    # without what the address sanitizer or the processor stops at anyhow, and what asks for RTTI of others: half of the
    # time that a source of Eigen takes to compile
    target_compile_options(${target} PUBLIC -fsanitize=${TUMBLE_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer
      -fno-sanitize=null,alignment,vptr,object-size,nonnull-attribute,returns-nonnull-attribute,pointer-overflow)
    target_link_options(${target} PUBLIC -fsanitize=${TUMBLE_SANITIZE})
  endif()
endfunction()

# Without the first ccache keeps nothing, of Clang as of GCC. The others: GCC 12 forgets that what it precompiled were
# system headers, and warns of std::string there.
function(tumble_precompiled_flags target)
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    target_compile_options(${target} PRIVATE -fpch-preprocess -Wno-array-bounds -Wno-stringop-overflow
      -Wno-stringop-overread)
  else()
    target_compile_options(${target} PRIVATE "SHELL:-Xclang -fno-pch-timestamp")
  endif()
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
