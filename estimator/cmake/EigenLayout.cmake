# tumble_eigen_alignment(OUT): to how many bytes Eigen aligns at most with the flags of this build. It follows from the
# vector instructions that the compiler may use, and is part of what matrices by value look like in memory.
include_guard()
include(CheckCXXSourceCompiles)

function(tumble_eigen_alignment out)
  set(CMAKE_REQUIRED_LIBRARIES Eigen3::Eigen)
  set(CMAKE_REQUIRED_QUIET ON)
  foreach(bytes 16 32 64 0)
    check_cxx_source_compiles("#include <Eigen/Core>\nstatic_assert(EIGEN_MAX_ALIGN_BYTES == ${bytes});\nint main() {}\n"
      TUMBLE_EIGEN_ALIGNS_TO_${bytes})
    if(TUMBLE_EIGEN_ALIGNS_TO_${bytes})
      set(${out} ${bytes} PARENT_SCOPE)
      return()
    endif()
  endforeach()
  message(FATAL_ERROR "Eigen aligns to neither 0, 16, 32 nor 64 bytes; see CMakeFiles/CMakeConfigureLog.yaml or CMakeError.log")
endfunction()
