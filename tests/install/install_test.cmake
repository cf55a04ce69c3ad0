# SPDX-License-Identifier: BSD-3-Clause
# Tests the library as users get it. estimator/ can be configured alone, with the same compiler arguments as in the
# whole tree.
# A project outside of the tree can use the installed library. Another project can contain the folder of the library.
# Negative controls: without the package, the project must not configure. A program with another memory layout must not
# link.
# Other compiler flags must be detected.
# With ALONE=ON, a copy of the folder is built and tested, then installed as files, as a Debian package and from its
# source archive. The project that contains the folder is built and run. The test with ALONE=ON takes as long as a
# build, so it belongs to the long suite.
include(${CMAKE_CURRENT_LIST_DIR}/compilations.cmake)

function(run expected)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE out ERROR_VARIABLE out)
  if(expected STREQUAL "passes" AND NOT status EQUAL 0)
    message(FATAL_ERROR "failed (${status}): ${ARGN}\n${out}")
  elseif(expected STREQUAL "fails" AND status EQUAL 0)
    message(FATAL_ERROR "passed, but must fail: ${ARGN}\n${out}")
  endif()
  set(output "${out}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
file(COPY ${SOURCE}/tests/install/consumer DESTINATION ${WORK})
set(common -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_BUILD_TYPE=${BUILD_TYPE})

run(fails ${CMAKE_COMMAND} -S ${WORK}/consumer -B ${WORK}/absent ${common} -DCMAKE_PREFIX_PATH=${WORK}/prefix)

run(passes ${CMAKE_COMMAND} -S ${SOURCE}/estimator -B ${WORK}/estimator ${common} ${OPTIONS} -DTUMBLE_PCL=ON
    -DCMAKE_EXPORT_COMPILE_COMMANDS=ON)
read_compilations(${BUILD} ${SOURCE}/estimator/src whole)
read_compilations(${WORK}/estimator ${SOURCE}/estimator/src alone)
compare_compilations("${whole}" "${alone}" difference)
if(NOT difference STREQUAL "")
  message(FATAL_ERROR "the library alone has other compiler arguments than in the whole tree: ${difference}")
endif()
list(TRANSFORM alone REPLACE " -O[0-9g]" " -O9" AT 0)
compare_compilations("${whole}" "${alone}" difference)
if(difference STREQUAL "")
  message(FATAL_ERROR "negative control: another optimisation of one file was not detected")
endif()

# consume PREFIX OPTION... builds and runs the consumer project outside of the tree, with the package in PREFIX
function(consume prefix)
  file(REMOVE_RECURSE ${WORK}/present)
  run(passes ${CMAKE_COMMAND} -S ${WORK}/consumer -B ${WORK}/present ${common} -DCMAKE_PREFIX_PATH=${prefix} ${ARGN})
  run(passes ${CMAKE_COMMAND} --build ${WORK}/present --parallel)
  run(passes ${WORK}/present/consumer)
  if(NOT output MATCHES "turned 3\\.14 rad in 251 samples")
    message(FATAL_ERROR "the consumer printed: ${output}")
  endif()
  run(passes ${WORK}/present/mapping_consumer)
  if(NOT output MATCHES "empty")
    message(FATAL_ERROR "the mapping consumer printed: ${output}")
  endif()
  run(passes ${WORK}/present/odometry_consumer)
  if(NOT output MATCHES "at rest: 1, rate 0\\.000 rad/s")
    message(FATAL_ERROR "the odometry consumer printed: ${output}")
  endif()
  run(passes ${CMAKE_COMMAND} --build ${WORK}/present --target alike_NDEBUG)
  foreach(unlike EIGEN_MAX_STATIC_ALIGN_BYTES EIGEN_DONT_VECTORIZE EIGEN_MALLOC_ALREADY_ALIGNED _GLIBCXX_DEBUG)
    run(fails ${CMAKE_COMMAND} --build ${WORK}/present --target alike_${unlike})
    if(NOT output MATCHES "CompilerSettingsCheck<")
      message(FATAL_ERROR "a program with ${unlike} did not link, but for an unexpected reason: ${output}")
    endif()
  endforeach()
endfunction()

# embed FOLDER configures a project that contains the estimator's folder. Its program must have the library's memory
# layout
function(embed folder)
  file(COPY ${SOURCE}/tests/install/embedded DESTINATION ${WORK})
  run(passes ${CMAKE_COMMAND} -S ${WORK}/embedded -B ${WORK}/robot ${common} -DESTIMATOR=${folder}
      -DCMAKE_EXPORT_COMPILE_COMMANDS=ON -DTUMBLE_ACCELERATE=${ACCELERATE})
  file(STRINGS ${WORK}/robot/compile_commands.json commands REGEX "\"command\":.*(/odometry|/status)\\.cpp")
  foreach(command IN LISTS commands)
    string(REGEX MATCHALL "-DEIGEN_(MAX_ALIGN_BYTES|MALLOC_ALREADY_ALIGNED)=[0-9]+" layout "${command}")
    list(APPEND layouts "${layout}")
    list(LENGTH layout stated)
    if(NOT stated EQUAL 2)
      message(FATAL_ERROR "the compiler arguments do not define the memory layout: ${command}")
    endif()
  endforeach()
  list(LENGTH commands compilations)
  list(REMOVE_DUPLICATES layouts)
  list(LENGTH layouts different)
  if(NOT compilations EQUAL 2 OR NOT different EQUAL 2)
    message(FATAL_ERROR "the program and the library in it state other layouts: ${layouts}")
  endif()
endfunction()
embed(${SOURCE}/estimator)

# the folder of the library has the licence of the whole project
run(passes ${CMAKE_COMMAND} -E compare_files ${SOURCE}/LICENSE ${SOURCE}/estimator/LICENSE)

if(NOT ALONE)
  run(passes ${CMAKE_COMMAND} --install ${BUILD}/estimator --prefix ${WORK}/prefix)
  consume(${WORK}/prefix)
  return()
endif()

# A copy of the folder is built, tested and installed. Its Debian package is unpacked to an empty folder. Its source
# archive is built and compared. The compiler cache is used if the tree uses it
list(APPEND OPTIONS -DTUMBLE_ACCELERATE=${ACCELERATE})
file(COPY ${SOURCE}/estimator DESTINATION ${WORK}/copy)
run(passes ${CMAKE_COMMAND} -S ${WORK}/copy/estimator -B ${WORK}/alone ${common} ${OPTIONS} -DTUMBLE_BUILD_TESTS=ON
    -DTUMBLE_PCL=ON)
run(passes ${CMAKE_COMMAND} --build ${WORK}/alone --parallel)
run(passes ${CMAKE_CTEST_COMMAND} --test-dir ${WORK}/alone --output-on-failure --no-tests=error)
run(passes ${CMAKE_COMMAND} --build ${WORK}/robot --parallel)
run(passes ${WORK}/robot/robot)
run(passes ${CMAKE_COMMAND} --install ${WORK}/alone --prefix ${WORK}/prefix)
consume(${WORK}/prefix -DWITH_PCL=ON)
run(passes ${WORK}/present/pcl_consumer)
if(NOT output MATCHES "3 points")
  message(FATAL_ERROR "the consumer of PCL printed: ${output}")
endif()

get_filename_component(bin ${CMAKE_COMMAND} DIRECTORY)
run(passes ${CMAKE_COMMAND} -E chdir ${WORK}/alone ${bin}/cpack)
file(GLOB packages ${WORK}/alone/libtumble-dev_*.deb)
run(passes dpkg-deb -x ${packages} ${WORK}/laid_down)
consume(${WORK}/laid_down/usr)

run(passes ${CMAKE_COMMAND} -E chdir ${WORK}/alone ${bin}/cpack --config CPackSourceConfig.cmake)
file(GLOB archives ${WORK}/alone/tumble-estimator-*.tar.gz)
file(ARCHIVE_EXTRACT INPUT ${archives} DESTINATION ${WORK}/source)
file(GLOB unpacked ${WORK}/source/*)
run(passes ${CMAKE_COMMAND} -S ${unpacked} -B ${WORK}/unpacked ${common} ${OPTIONS})
