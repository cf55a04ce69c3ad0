# Compiles through ccache and links with mold, which saves time and gives the same result. The launcher sets up ccache.
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
  if(TUMBLE_MOLD AND NOT CMAKE_CROSSCOMPILING AND CMAKE_CXX_COMPILER_ID STREQUAL GNU
      AND CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 12.1)
    target_link_options(${target} PRIVATE -fuse-ld=mold)
  endif()
endfunction()

# tumble_target(TARGET [LIGHT|COMPUTES]) sets the language level, warnings and instrumentation of a target.
# LIGHT: low optimisation, for code that needs little run time (command line, pages, tests). Compiling takes two thirds
# of the time; results are bit-identical. COMPUTES: full optimisation even with TUMBLE_LIGHT, for code that tests wait
# for.
# The function sets no global flags, so that a project that embeds this one keeps its own flags.
include_guard()

option(TUMBLE_EIGEN_NAN "Initialise Eigen matrices to NaN, to detect use before assignment" OFF)
option(TUMBLE_WARNINGS "Enable compiler warnings; a build of a released version does not need them" ON)
option(TUMBLE_WARNINGS_AS_ERRORS "Warnings fail the build" OFF)
option(TUMBLE_PRECOMPILE "Precompile common headers, once per library and once for all tests" OFF)
option(TUMBLE_LIGHT "Compile with low optimisation, except targets that are marked COMPUTES" OFF)
option(TUMBLE_UNITY "Compile several sources of a target as one unit" OFF)
option(TUMBLE_ACCELERATE "Compile through ccache and link with mold, if they are installed" OFF)
set(TUMBLE_SANITIZE "" CACHE STRING "Sanitizers, comma separated: address,undefined,fuzzer-no-link (only Clang) or thread")

function(tumble_target target)
  cmake_parse_arguments(arg "LIGHT;COMPUTES" "" "" ${ARGN})
  if(TUMBLE_LIGHT AND NOT arg_COMPUTES)
    set(arg_LIGHT ON)
  endif()
  target_compile_features(${target} PUBLIC cxx_std_20)
  tumble_accelerate(${target})
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF POSITION_INDEPENDENT_CODE ON)
  if(TUMBLE_UNITY)  # common templates are instantiated once per unit; names must therefore be unique within a target
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 8)
    if(arg_LIGHT)
      set_target_properties(${target} PROPERTIES UNITY_BUILD_BATCH_SIZE 16)
    endif()
    # GCC treats private types of a joined source as if they were in a header, and warns
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  endif()
  # -Wrestrict of GCC 12 reports false positives for every concatenation of strings (GCC bug 105329)
  # Without fused multiply-add, results are bit-identical on every x86-64 processor
  target_compile_options(${target} PRIVATE
    $<$<BOOL:${TUMBLE_WARNINGS}>:-Wall -Wextra -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual>
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
    -ffp-contract=off
    $<$<CONFIG:Release>:$<IF:$<BOOL:${arg_LIGHT}>,-O1,-O3>>)
  # By default, GCC collects garbage when it uses more than 128 MiB, which makes sources with many templates slow. This
  # limit needs more memory, but less time (measured by `time` of their commands in compile_commands.json)
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=524288>)
  if(TUMBLE_WARNINGS_AS_ERRORS)
    # GCC reports false maybe-uninitialized warnings for the storage of Eigen matrices
    target_compile_options(${target} PRIVATE -Werror $<$<CXX_COMPILER_ID:GNU>:-Wno-error=maybe-uninitialized>)
  endif()
  if(TUMBLE_EIGEN_NAN)
    target_compile_definitions(${target} PUBLIC EIGEN_INITIALIZE_MATRICES_BY_NAN)
  endif()
  if(TUMBLE_SANITIZE)
    # The excluded checks are redundant, because the address sanitizer or the processor detects the same faults, or need
    # RTTI of other libraries. Without them, a source with Eigen compiles in half the time
    target_compile_options(${target} PUBLIC -fsanitize=${TUMBLE_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer
      -fno-sanitize=null,alignment,vptr,object-size,nonnull-attribute,returns-nonnull-attribute,pointer-overflow)
    target_link_options(${target} PUBLIC -fsanitize=${TUMBLE_SANITIZE})
  endif()
endfunction()

# ccache needs the first flag of each compiler. The other flags suppress false warnings about std::string, because GCC
# 12 does not treat precompiled headers as system headers.
function(tumble_precompiled_flags target)
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    target_compile_options(${target} PRIVATE -fpch-preprocess -Wno-array-bounds -Wno-stringop-overflow
      -Wno-stringop-overread)
  else()
    target_compile_options(${target} PRIVATE "SHELL:-Xclang -fno-pch-timestamp")
  endif()
endfunction()

# tumble_precompile(TARGET HEADER...) precompiles headers for all files of a target. Precompiled headers only save time:
# every file still includes the headers that it uses. The debug build has no precompiled headers, so it detects missing
# includes.
function(tumble_precompile target)
  if(NOT TUMBLE_PRECOMPILE)
    return()
  endif()
  target_precompile_headers(${target} PRIVATE ${ARGN})
  tumble_precompiled_flags(${target})
endfunction()

# tumble_precompile_as(TARGET OTHER) uses the precompiled headers of OTHER, which must have the same flags.
function(tumble_precompile_as target other)
  if(NOT TUMBLE_PRECOMPILE)
    return()
  endif()
  target_precompile_headers(${target} REUSE_FROM ${other})
  tumble_precompiled_flags(${target})
endfunction()
