# Runs at build time: writes OUTPUT from INPUT with the identity of the sources under ROOT, only if it changed.
file(GLOB_RECURSE sources LIST_DIRECTORIES false RELATIVE ${ROOT}
  ${ROOT}/estimator/*.hpp ${ROOT}/estimator/*.cpp ${ROOT}/sim/*.hpp ${ROOT}/sim/*.cpp
  ${ROOT}/scenarios/*.hpp ${ROOT}/scenarios/*.cpp ${ROOT}/scenarios/*.py ${ROOT}/tools/cmake/*.cmake
  ${ROOT}/estimator/cmake/TumbleTarget.cmake)
list(FILTER sources EXCLUDE REGEX "^estimator/tests/")
list(SORT sources)
set(all "")
foreach(source IN LISTS sources)
  file(SHA256 ${ROOT}/${source} hash)
  string(APPEND all "${source} ${hash}\n")
endforeach()
string(SHA256 digest "${all}")
string(SUBSTRING ${digest} 0 16 digest)
set(identity "${VERSION} ${digest} ${COMPILER} ${BUILD_TYPE}")
configure_file(${INPUT} ${OUTPUT} @ONLY)
