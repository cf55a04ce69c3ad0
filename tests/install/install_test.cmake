# SPDX-License-Identifier: BSD-3-Clause
# estimator/ configured alone, built, installed; then a consumer outside of the tree, and a negative control: the consumer must
# fail to configure when the package is not there.
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
set(common -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_BUILD_TYPE=Release)

run(fails ${CMAKE_COMMAND} -S ${WORK}/consumer -B ${WORK}/absent ${common} -DCMAKE_PREFIX_PATH=${WORK}/prefix)
run(passes ${CMAKE_COMMAND} -S ${SOURCE}/estimator -B ${WORK}/estimator ${common} -DTUMBLE_PRECOMPILE=ON
    -DCMAKE_INSTALL_PREFIX=${WORK}/prefix)
run(passes ${CMAKE_COMMAND} --build ${WORK}/estimator --parallel --target install)
run(passes ${CMAKE_COMMAND} -S ${WORK}/consumer -B ${WORK}/present ${common} -DCMAKE_PREFIX_PATH=${WORK}/prefix)
run(passes ${CMAKE_COMMAND} --build ${WORK}/present)
run(passes ${WORK}/present/consumer)
if(NOT output MATCHES "position 0\\.2278")
  message(FATAL_ERROR "the consumer printed: ${output}")
endif()
run(passes ${WORK}/present/mapping_consumer)
if(NOT output MATCHES "empty")
  message(FATAL_ERROR "the mapping consumer printed: ${output}")
endif()
