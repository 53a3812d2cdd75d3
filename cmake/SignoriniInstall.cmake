# install + export + build-tree export. A component is a library: find_package(signorini COMPONENTS lcp).
# Each has an export set of its own, so that asking for one does not ask for the others' dependencies.
include(CMakePackageConfigHelpers)

set(SIGNORINI_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/signorini)
get_property(libraries GLOBAL PROPERTY SIGNORINI_LIBRARIES)
foreach(target ${libraries})
  string(REPLACE signorini_ "" component ${target})
  install(TARGETS ${target} EXPORT signorini-${component}-targets)
  install(EXPORT signorini-${component}-targets NAMESPACE signorini:: DESTINATION ${SIGNORINI_CMAKE_DIR})
  export(EXPORT signorini-${component}-targets NAMESPACE signorini::
         FILE ${PROJECT_BINARY_DIR}/signorini-${component}-targets.cmake)
endforeach()

get_property(programs GLOBAL PROPERTY SIGNORINI_PROGRAMS)
if(programs)
  install(TARGETS ${programs})
endif()
foreach(part lcp core collision)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${part} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/signorini
          FILES_MATCHING PATTERN "*.h")
endforeach()

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/signorini-config.cmake.in
  ${PROJECT_BINARY_DIR}/signorini-config.cmake INSTALL_DESTINATION ${SIGNORINI_CMAKE_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/signorini-config-version.cmake
  COMPATIBILITY SameMinorVersion)
file(COPY ${PROJECT_SOURCE_DIR}/cmake/FindGMP.cmake ${PROJECT_SOURCE_DIR}/cmake/FindCHOLMOD.cmake
     DESTINATION ${PROJECT_BINARY_DIR})
install(FILES ${PROJECT_BINARY_DIR}/signorini-config.cmake
              ${PROJECT_BINARY_DIR}/signorini-config-version.cmake
              ${PROJECT_SOURCE_DIR}/cmake/FindGMP.cmake
              ${PROJECT_SOURCE_DIR}/cmake/FindCHOLMOD.cmake
        DESTINATION ${SIGNORINI_CMAKE_DIR})
