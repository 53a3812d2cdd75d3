# The libraries that signorini-bench compares us with. Each is optional: what is found becomes a part
# of signorini_peer_libraries with SIGNORINI_PEER_<NAME> defined; what is not is named.
# Nothing but bench/ may link it.
include(CheckCXXSourceCompiles)

option(SIGNORINI_PEER_BULLET "Compare with Bullet's solvers (libbullet-dev, double precision)" ON)
option(SIGNORINI_PEER_ODE "Compare with ODE's Dantzig (libode-dev)" ON)
option(SIGNORINI_PEER_DART "Compare with DART's Dantzig, PGS and Lemke (libdart-dev)" ON)
option(SIGNORINI_PEER_SICONOS "Compare with Siconos (libsiconos-numerics-dev)" ON)

add_library(signorini_peer_libraries INTERFACE)

function(signorini_peer_found name libraries include_dirs)
  target_link_libraries(signorini_peer_libraries INTERFACE ${libraries})
  target_include_directories(signorini_peer_libraries SYSTEM INTERFACE ${include_dirs})
  target_compile_definitions(signorini_peer_libraries INTERFACE SIGNORINI_PEER_${name})
  set_property(GLOBAL APPEND PROPERTY SIGNORINI_PEERS ${name})
endfunction()

function(signorini_peer_lost name package what)
  message(STATUS "signorini-bench peers: without ${what}; ${package} was not found")
endfunction()

if(SIGNORINI_PEER_BULLET)
  find_package(BulletDouble QUIET)
  if(BulletDouble_FOUND)
    # By its files: the imported target would have to be found again in every folder that links us.
    signorini_peer_found(BULLET "${BulletDouble_LIBRARIES}" "${BulletDouble_INCLUDE_DIR}")
    target_compile_definitions(signorini_peer_libraries INTERFACE BT_USE_DOUBLE_PRECISION)
  else()
    signorini_peer_lost(BULLET libbullet-dev "Bullet's Dantzig, Lemke and PGS, and its contact sets")
  endif()
endif()

if(SIGNORINI_PEER_ODE)
  find_path(ODE_INCLUDE_DIR ode/ode.h)
  find_library(ODE_LIBRARY ode)
  mark_as_advanced(ODE_INCLUDE_DIR ODE_LIBRARY)
  if(ODE_INCLUDE_DIR AND ODE_LIBRARY)
    set(CMAKE_REQUIRED_INCLUDES ${ODE_INCLUDE_DIR})
    set(CMAKE_REQUIRED_LIBRARIES ${ODE_LIBRARY})
    # The Dantzig is internal; this library must export it, in double precision.
    check_cxx_source_compiles("
      #include <cstddef>
      #include <ode/ode.h>
      static_assert(sizeof(dReal) == sizeof(double));
      class dxWorldProcessMemArena;
      class dxWorldProcessMemoryManager;
      struct dxWorldProcessMemoryReserveInfo;
      void dxSolveLCP(dxWorldProcessMemArena*, unsigned, double*, double*, double*, unsigned,
                      double*, int*);
      std::size_t dxEstimateSolveLCPMemoryReq(unsigned, bool);
      dxWorldProcessMemArena* dxAllocateTemporaryWorldProcessMemArena(
          std::size_t, const dxWorldProcessMemoryManager*, const dxWorldProcessMemoryReserveInfo*);
      int main() {
        auto* arena = dxAllocateTemporaryWorldProcessMemArena(
            dxEstimateSolveLCPMemoryReq(1, false), nullptr, nullptr);
        dxSolveLCP(arena, 0, nullptr, nullptr, nullptr, 0, nullptr, nullptr);
      }" SIGNORINI_ODE_EXPORTS_ITS_DANTZIG)
    unset(CMAKE_REQUIRED_INCLUDES)
    unset(CMAKE_REQUIRED_LIBRARIES)
  endif()
  if(SIGNORINI_ODE_EXPORTS_ITS_DANTZIG)
    signorini_peer_found(ODE ${ODE_LIBRARY} "${ODE_INCLUDE_DIR}")
  else()
    signorini_peer_lost(ODE "libode-dev (0.16, double precision, its Dantzig exported)" "ODE's Dantzig")
  endif()
endif()

if(SIGNORINI_PEER_DART)
  find_package(DartSim QUIET)
  if(DartSim_FOUND)
    signorini_peer_found(DART ${DartSim_LIBRARY} "${DartSim_INCLUDE_DIR}")
  else()
    signorini_peer_lost(DART libdart-dev "DART's Dantzig, Lemke and PGS")
  endif()
endif()

if(SIGNORINI_PEER_SICONOS)
  find_path(SICONOS_INCLUDE_DIR NonSmoothDrivers.h PATH_SUFFIXES siconos/numerics)
  find_path(SICONOS_CONFIG_DIR SiconosConfig.h PATH_SUFFIXES siconos)
  find_library(SICONOS_LIBRARY siconos_numerics)
  mark_as_advanced(SICONOS_INCLUDE_DIR SICONOS_CONFIG_DIR SICONOS_LIBRARY)
  if(SICONOS_INCLUDE_DIR AND SICONOS_CONFIG_DIR AND SICONOS_LIBRARY)
    signorini_peer_found(SICONOS ${SICONOS_LIBRARY} "${SICONOS_INCLUDE_DIR};${SICONOS_CONFIG_DIR}")
  else()
    signorini_peer_lost(SICONOS libsiconos-numerics-dev "Siconos")
  endif()
endif()
