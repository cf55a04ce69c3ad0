# Finds MuJoCo >= 3.5 and defines MuJoCo::MuJoCo. Searches first in MUJOCO_DIR (a folder with include/mujoco and the library),
# then in the wheel that tools/setup downloads, then in the system.
set(_mujoco_deps "${CMAKE_SOURCE_DIR}/build/deps")
if(DEFINED ENV{TUMBLE_DEPS_DIR})
  set(_mujoco_deps "$ENV{TUMBLE_DEPS_DIR}")
endif()
file(GLOB _mujoco_wheels LIST_DIRECTORIES true "${_mujoco_deps}/mujoco-*/mujoco")

find_path(MuJoCo_INCLUDE_DIR mujoco/mujoco.h HINTS ${MUJOCO_DIR} ENV MUJOCO_DIR ${_mujoco_wheels} PATH_SUFFIXES include)
find_library(MuJoCo_LIBRARY NAMES mujoco HINTS ${MUJOCO_DIR} ENV MUJOCO_DIR ${_mujoco_wheels} PATH_SUFFIXES lib .)

if(MuJoCo_INCLUDE_DIR AND EXISTS "${MuJoCo_INCLUDE_DIR}/mujoco/mujoco.h")
  file(STRINGS "${MuJoCo_INCLUDE_DIR}/mujoco/mujoco.h" _line REGEX "#define mjVERSION_HEADER +[0-9]+")
  string(REGEX MATCH "[0-9]+$" _number "${_line}")
  if(_number GREATER_EQUAL 1000000)  # 3.4 and later: major * 1e6 + minor * 1e3 + patch
    math(EXPR _major "${_number} / 1000000")
    math(EXPR _minor "${_number} / 1000 % 1000")
    math(EXPR _patch "${_number} % 1000")
  else()  # one digit per part of the version
    math(EXPR _major "${_number} / 100")
    math(EXPR _minor "${_number} / 10 % 10")
    math(EXPR _patch "${_number} % 10")
  endif()
  set(MuJoCo_VERSION "${_major}.${_minor}.${_patch}")
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(MuJoCo REQUIRED_VARS MuJoCo_LIBRARY MuJoCo_INCLUDE_DIR VERSION_VAR MuJoCo_VERSION
  REASON_FAILURE_MESSAGE "run tools/setup, or set MUJOCO_DIR to an installed MuJoCo of at least 3.5")

if(MuJoCo_FOUND AND NOT TARGET MuJoCo::MuJoCo)
  add_library(MuJoCo::MuJoCo SHARED IMPORTED)
  set_target_properties(MuJoCo::MuJoCo PROPERTIES
    IMPORTED_LOCATION "${MuJoCo_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES "${MuJoCo_INCLUDE_DIR}")
endif()
