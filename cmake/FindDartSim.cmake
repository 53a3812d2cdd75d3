# DART, the dynamics engine (Debian: libdart-dev): target DartSim::DartSim. By its header and library:
# DART's own package file asks for Boost, FCL and more, which who only solves for it does not need.
find_path(DartSim_INCLUDE_DIR dart/constraint/BoxedLcpSolver.hpp)
find_library(DartSim_LIBRARY dart)
mark_as_advanced(DartSim_INCLUDE_DIR DartSim_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(DartSim REQUIRED_VARS DartSim_INCLUDE_DIR DartSim_LIBRARY)

if(DartSim_FOUND AND NOT TARGET DartSim::DartSim)
  add_library(DartSim::DartSim INTERFACE IMPORTED)
  set_target_properties(DartSim::DartSim PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES ${DartSim_INCLUDE_DIR}
    INTERFACE_LINK_LIBRARIES ${DartSim_LIBRARY})
endif()
