# What others install: `cpack` in the build folder makes a Debian package of what `cmake --install` lays down, `cpack
# --config CPackSourceConfig.cmake` an archive of this folder.
set(CPACK_PACKAGE_NAME libtumble-dev)
set(CPACK_PACKAGE_VENDOR "tumble")
set(CPACK_PACKAGE_CONTACT "the authors of tumble <tumble@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY ${PROJECT_DESCRIPTION})
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_RESOURCE_FILE_LICENSE ${CMAKE_CURRENT_SOURCE_DIR}/LICENSE)
set(CPACK_GENERATOR DEB)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libeigen3-dev (>= 3.4)")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "libpcl-dev")  # for tumble::pcl alone
set(CPACK_SOURCE_GENERATOR TGZ)
set(CPACK_SOURCE_PACKAGE_FILE_NAME tumble-estimator-${PROJECT_VERSION})
# a regular expression on whole paths: a build folder within
set(CPACK_SOURCE_IGNORE_FILES "^${CMAKE_CURRENT_BINARY_DIR}/")
install(FILES ${CMAKE_CURRENT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright)
include(CPack)
