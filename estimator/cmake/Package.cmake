# Packages for distribution. In the build folder, `cpack` makes a Debian package of the installed files, and
# `cpack --config CPackSourceConfig.cmake` makes a source archive of this folder.
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
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "libpcl-dev")  # only for tumble::pcl
set(CPACK_SOURCE_GENERATOR TGZ)
set(CPACK_SOURCE_PACKAGE_FILE_NAME tumble-estimator-${PROJECT_VERSION})
# regular expression on whole paths, for a build folder inside this folder
set(CPACK_SOURCE_IGNORE_FILES "^${CMAKE_CURRENT_BINARY_DIR}/")
install(FILES ${CMAKE_CURRENT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright)
include(CPack)
