# install + export + build-tree export + pkg-config. A component is a library: find_package(signorini
# COMPONENTS lcp). Each has an export set of its own, so that asking for one does not ask for the
# others' dependencies. Files belong to packages: libraries, development, tools, and the libraries for
# an engine to that engine's, so that the others do not bring the engine in.
include(CMakePackageConfigHelpers)

set(SIGNORINI_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/signorini)
set(development COMPONENT development)
get_property(libraries GLOBAL PROPERTY SIGNORINI_LIBRARIES)
foreach(target ${libraries})
  string(REPLACE signorini_ "" component ${target})
  set(package libraries)
  if(component MATCHES "^(bullet|dart)")
    set(package ${CMAKE_MATCH_1})
  endif()
  install(TARGETS ${target} EXPORT signorini-${component}-targets
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${package} NAMELINK_COMPONENT development
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} ${development})
  install(EXPORT signorini-${component}-targets NAMESPACE signorini::
          DESTINATION ${SIGNORINI_CMAKE_DIR} ${development})
  export(EXPORT signorini-${component}-targets NAMESPACE signorini::
         FILE ${PROJECT_BINARY_DIR}/signorini-${component}-targets.cmake)
endforeach()

get_property(programs GLOBAL PROPERTY SIGNORINI_PROGRAMS)
if(programs)
  install(TARGETS ${programs} DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT tools)
endif()
foreach(part lcp core collision)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${part} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/signorini
          ${development} FILES_MATCHING PATTERN "*.h")
endforeach()
foreach(engine bullet dart)
  if(TARGET signorini_${engine} OR TARGET signorini_${engine}_float)
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/integrations/${engine}
            DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/signorini/integrations
            ${development} FILES_MATCHING PATTERN "*.h" PATTERN example_scenes EXCLUDE)
  endif()
endforeach()
if(TARGET signorini_c)  # whose other headers are its own
  install(FILES ${PROJECT_SOURCE_DIR}/c/signorini.h
          DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/signorini/c ${development})
endif()

# The guides and the examples, in folders as here, so that links hold.
set(documentation ${CMAKE_INSTALL_DATAROOTDIR}/doc/signorini)
foreach(folder . bench c collision core integrations/bullet integrations/dart lcp lcp/io python tools
               validation validation/report)
  install(FILES ${PROJECT_SOURCE_DIR}/${folder}/README.md DESTINATION ${documentation}/${folder}
          ${development})
endforeach()
install(FILES ${PROJECT_SOURCE_DIR}/CHANGELOG.md ${PROJECT_SOURCE_DIR}/LICENSE
        DESTINATION ${documentation} ${development})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs ${PROJECT_SOURCE_DIR}/examples
        DESTINATION ${documentation} ${development}
        FILES_MATCHING REGEX "[.](md|png|svg|c|cpp|py)$")

# Of its libraries a static build must name all when it is linked, a shared one its interface.
set(SIGNORINI_C_NEEDS lcp model core)
if(TARGET signorini_io)
  list(APPEND SIGNORINI_C_NEEDS io)
endif()
list(JOIN SIGNORINI_C_NEEDS " " SIGNORINI_C_NEEDS)

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/signorini-config.cmake.in
  ${PROJECT_BINARY_DIR}/signorini-config.cmake INSTALL_DESTINATION ${SIGNORINI_CMAKE_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/signorini-config-version.cmake
  COMPATIBILITY SameMinorVersion)
set(SIGNORINI_FIND_MODULES)
foreach(package GMP CHOLMOD BulletDouble BulletFloat DartSim)
  list(APPEND SIGNORINI_FIND_MODULES ${PROJECT_SOURCE_DIR}/cmake/Find${package}.cmake)
endforeach()
file(COPY ${SIGNORINI_FIND_MODULES} DESTINATION ${PROJECT_BINARY_DIR})
install(FILES ${PROJECT_BINARY_DIR}/signorini-config.cmake
              ${PROJECT_BINARY_DIR}/signorini-config-version.cmake
              ${SIGNORINI_FIND_MODULES}
        DESTINATION ${SIGNORINI_CMAKE_DIR} ${development})

# pkg-config: signorini-lcp.pc and so on, for builds without CMake; they find themselves, wherever
# the tree was put.
file(RELATIVE_PATH SIGNORINI_PC_PREFIX
     ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
function(signorini_pkg_config component description)
  cmake_parse_arguments(ARG "" "" "REQUIRES;PRIVATE_REQUIRES;PRIVATE_LIBS" ${ARGN})
  if(NOT TARGET signorini_${component})
    return()
  endif()
  list(JOIN ARG_REQUIRES ", " requires)
  list(JOIN ARG_PRIVATE_REQUIRES ", " private_requires)
  list(JOIN ARG_PRIVATE_LIBS " " private_libs)
  set(file ${PROJECT_BINARY_DIR}/signorini-${component}.pc)
  file(CONFIGURE OUTPUT ${file} @ONLY CONTENT [[
prefix=${pcfiledir}/@SIGNORINI_PC_PREFIX@
Name: signorini-@component@
Description: @description@
Version: @PROJECT_VERSION@
Requires: @requires@
Requires.private: @private_requires@
Cflags: -I${prefix}/@CMAKE_INSTALL_INCLUDEDIR@
Libs: -L${prefix}/@CMAKE_INSTALL_LIBDIR@ -lsignorini-@component@
Libs.private: @private_libs@
]])
  install(FILES ${file} DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig ${development})
endfunction()

set(lcp_private)
if(SIGNORINI_WITH_CHOLMOD)
  list(APPEND lcp_private -lcholmod -lgomp)
endif()
if(SIGNORINI_WITH_GMP)
  list(APPEND lcp_private -lgmpxx -lgmp)
endif()
set(io_private -lfmt)
if(TARGET signorini_io AND SIGNORINI_WITH_HDF5)
  get_target_property(hdf5_library hdf5::hdf5 LOCATION)
  list(APPEND io_private ${hdf5_library})
endif()
signorini_pkg_config(lcp "linear complementarity problems, solved and certified"
  REQUIRES eigen3 PRIVATE_LIBS ${lcp_private} -pthread -lstdc++ -lm)
signorini_pkg_config(io "problem folders, dump and replay" REQUIRES signorini-lcp
  PRIVATE_LIBS ${io_private})
signorini_pkg_config(model "bodies, contacts, motion" REQUIRES eigen3)
signorini_pkg_config(core "impacts, resting forces, time stepping"
  REQUIRES signorini-model signorini-lcp)
signorini_pkg_config(bullet "our solvers inside Bullet, double precision"
  REQUIRES signorini-lcp bullet-float64)
signorini_pkg_config(bullet_float "our solvers inside Bullet, single precision"
  REQUIRES signorini-lcp bullet)
signorini_pkg_config(dart "our solvers inside DART" REQUIRES signorini-lcp dart)
signorini_pkg_config(hulls "convex hulls of points" REQUIRES signorini-collision
  PRIVATE_LIBS -lqhull_r)
signorini_pkg_config(mesh_files "triangles of mesh files" REQUIRES signorini-model
  PRIVATE_LIBS -lassimp)
signorini_pkg_config(collision "shapes, contact sets, contact times" REQUIRES signorini-model)
string(REGEX REPLACE "([a-z]+)" "signorini-\\1" c_requires "${SIGNORINI_C_NEEDS}")
string(REPLACE " " ";" c_requires "${c_requires}")
list(REVERSE c_requires)
signorini_pkg_config(c "the C API" PRIVATE_REQUIRES ${c_requires})

if(PROJECT_IS_TOP_LEVEL)
  include(SignoriniPackages)
endif()
