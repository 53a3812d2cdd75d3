# install + export + build-tree export. A component is a library: find_package(signorini COMPONENTS lcp).
include(CMakePackageConfigHelpers)

get_property(libraries GLOBAL PROPERTY SIGNORINI_LIBRARIES)
get_property(programs GLOBAL PROPERTY SIGNORINI_PROGRAMS)
install(TARGETS ${libraries} EXPORT signorini-targets)
if(programs)
  install(TARGETS ${programs})
endif()
foreach(part lcp core collision)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${part} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/signorini
          FILES_MATCHING PATTERN "*.h")
endforeach()
install(EXPORT signorini-targets NAMESPACE signorini::
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/signorini)
export(EXPORT signorini-targets NAMESPACE signorini:: FILE ${PROJECT_BINARY_DIR}/signorini-targets.cmake)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/signorini-config.cmake.in
  ${PROJECT_BINARY_DIR}/signorini-config.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/signorini)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/signorini-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/signorini-config.cmake
              ${PROJECT_BINARY_DIR}/signorini-config-version.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/signorini)
