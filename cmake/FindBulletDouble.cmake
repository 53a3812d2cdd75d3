# Bullet in double precision (Debian: libbullet-dev): target Bullet::Double. Its headers are those
# of the float build; BT_USE_DOUBLE_PRECISION tells them apart.
find_path(BulletDouble_INCLUDE_DIR btBulletDynamicsCommon.h PATH_SUFFIXES bullet)
foreach(part BulletDynamics BulletCollision LinearMath)
  find_library(BulletDouble_${part}_LIBRARY ${part}-float64)
  list(APPEND BulletDouble_LIBRARIES ${BulletDouble_${part}_LIBRARY})
  mark_as_advanced(BulletDouble_${part}_LIBRARY)
endforeach()
mark_as_advanced(BulletDouble_INCLUDE_DIR)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(BulletDouble REQUIRED_VARS
  BulletDouble_INCLUDE_DIR BulletDouble_BulletDynamics_LIBRARY
  BulletDouble_BulletCollision_LIBRARY BulletDouble_LinearMath_LIBRARY)

if(BulletDouble_FOUND AND NOT TARGET Bullet::Double)
  add_library(Bullet::Double INTERFACE IMPORTED)
  set_target_properties(Bullet::Double PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES ${BulletDouble_INCLUDE_DIR}
    INTERFACE_COMPILE_DEFINITIONS BT_USE_DOUBLE_PRECISION
    INTERFACE_LINK_LIBRARIES "${BulletDouble_LIBRARIES}")
endif()
