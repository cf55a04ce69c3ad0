# tumble_eigen_layout(OUT): the definitions that keep Eigen's matrices in memory as the flags of this build lay them out:
# to how many bytes Eigen aligns at most, and whether it takes memory from malloc as it is. Both follow from the vector
# instructions that the compiler may use, and from sanitizers.
include_guard()
include(CheckCXXSourceCompiles)

# tumble_eigen_states(OUT CONDITION): whether Eigen's macros fulfil it
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
