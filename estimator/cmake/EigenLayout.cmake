# tumble_eigen_layout(OUT) returns definitions that fix the memory layout of Eigen matrices to the layout of this build.
# The layout is Eigen's largest alignment in bytes, and whether Eigen assumes that malloc aligns its memory. Both depend
# on the vector instructions that the compiler may use, and on sanitizers.
include_guard()
include(CheckCXXSourceCompiles)

# tumble_eigen_states(OUT CONDITION) checks whether Eigen's macros fulfil the condition
function(tumble_eigen_states out condition)
  set(CMAKE_REQUIRED_LIBRARIES Eigen3::Eigen)
  set(CMAKE_REQUIRED_QUIET ON)
  check_cxx_source_compiles("#include <Eigen/Core>\nstatic_assert(${condition});\nint main() {}\n" ${out})
endfunction()

function(tumble_eigen_layout out)
  tumble_eigen_states(TUMBLE_EIGEN_USES_MALLOC "EIGEN_MALLOC_ALREADY_ALIGNED")
  foreach(bytes 16 32 64 0)
    tumble_eigen_states(TUMBLE_EIGEN_ALIGNS_TO_${bytes} "EIGEN_MAX_ALIGN_BYTES == ${bytes}")
    if(TUMBLE_EIGEN_ALIGNS_TO_${bytes})
      set(${out} EIGEN_MAX_ALIGN_BYTES=${bytes} EIGEN_MALLOC_ALREADY_ALIGNED=$<BOOL:${TUMBLE_EIGEN_USES_MALLOC}>
        PARENT_SCOPE)
      return()
    endif()
  endforeach()
  message(FATAL_ERROR "Eigen aligns to neither 0, 16, 32 nor 64 bytes; see CMakeFiles/CMakeConfigureLog.yaml or CMakeError.log")
endfunction()
