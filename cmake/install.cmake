# What `cmake --install` lays down: headers, library, find_package and pkg-config files, the command line.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS avbd EXPORT avbdTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY include/avbd DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})

set(AVBD_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/avbd)
install(EXPORT avbdTargets NAMESPACE avbd:: DESTINATION ${AVBD_CMAKE_DIR})
configure_package_config_file(cmake/avbdConfig.cmake.in ${CMAKE_BINARY_DIR}/avbdConfig.cmake
                              INSTALL_DESTINATION ${AVBD_CMAKE_DIR})
# Before 1.0 a minor version may change the interface.
write_basic_package_version_file(${CMAKE_BINARY_DIR}/avbdConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/avbdConfig.cmake ${CMAKE_BINARY_DIR}/avbdConfigVersion.cmake
        DESTINATION ${AVBD_CMAKE_DIR})

configure_file(cmake/avbd.pc.in ${CMAKE_BINARY_DIR}/avbd.pc @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/avbd.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
if(TARGET avbd_app)
  install(TARGETS avbd_app RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
