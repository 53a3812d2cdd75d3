# The libraries whose collision detection signorini-bench puts beside ours. Each is optional: what is
# found becomes a part of signorini_collision_peer_libraries with SIGNORINI_PEER_<NAME> defined; what
# is not is named. Nothing but bench/ may link it. Needs SignoriniPeers (Bullet).
option(SIGNORINI_PEER_FCL "Compare with FCL's broad and narrow phase (libfcl-dev)" ON)
option(SIGNORINI_PEER_BOOST "Compare with Boost.Geometry's R-tree (libboost-dev)" ON)

add_library(signorini_collision_peer_libraries INTERFACE)
set(collision_peers)

if(BulletDouble_FOUND)
  target_link_libraries(signorini_collision_peer_libraries INTERFACE ${BulletDouble_LIBRARIES})
  target_include_directories(signorini_collision_peer_libraries SYSTEM INTERFACE
    ${BulletDouble_INCLUDE_DIR})
  target_compile_definitions(signorini_collision_peer_libraries INTERFACE
    SIGNORINI_PEER_BULLET BT_USE_DOUBLE_PRECISION)
  list(APPEND collision_peers bullet)
endif()

if(SIGNORINI_PEER_FCL)
  find_path(FCL_INCLUDE_DIR fcl/broadphase/broadphase_dynamic_AABB_tree.h)
  find_library(FCL_LIBRARY fcl)
  find_library(CCD_LIBRARY ccd)
  mark_as_advanced(FCL_INCLUDE_DIR FCL_LIBRARY CCD_LIBRARY)
  if(FCL_INCLUDE_DIR AND FCL_LIBRARY AND CCD_LIBRARY)
    target_link_libraries(signorini_collision_peer_libraries INTERFACE ${FCL_LIBRARY} ${CCD_LIBRARY})
    target_include_directories(signorini_collision_peer_libraries SYSTEM INTERFACE ${FCL_INCLUDE_DIR})
    target_compile_definitions(signorini_collision_peer_libraries INTERFACE SIGNORINI_PEER_FCL)
    list(APPEND collision_peers fcl)
  else()
    message(STATUS "signorini-bench: without FCL's collision detection; libfcl-dev was not found")
  endif()
endif()

if(SIGNORINI_PEER_BOOST)
  find_path(BOOST_GEOMETRY_INCLUDE_DIR boost/geometry/index/rtree.hpp)
  mark_as_advanced(BOOST_GEOMETRY_INCLUDE_DIR)
  if(BOOST_GEOMETRY_INCLUDE_DIR)
    target_include_directories(signorini_collision_peer_libraries SYSTEM INTERFACE
      ${BOOST_GEOMETRY_INCLUDE_DIR})
    target_compile_definitions(signorini_collision_peer_libraries INTERFACE SIGNORINI_PEER_BOOST)
    list(APPEND collision_peers boost)
  else()
    message(STATUS "signorini-bench: without Boost's R-tree; libboost-dev was not found")
  endif()
endif()
