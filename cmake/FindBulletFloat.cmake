# Bullet in single precision (Debian: libbullet-dev): target Bullet::Float.
find_path(BulletFloat_INCLUDE_DIR btBulletDynamicsCommon.h PATH_SUFFIXES bullet)
foreach(part BulletDynamics BulletCollision LinearMath)
  find_library(BulletFloat_${part}_LIBRARY ${part})
  list(APPEND BulletFloat_LIBRARIES ${BulletFloat_${part}_LIBRARY})
  mark_as_advanced(BulletFloat_${part}_LIBRARY)
endforeach()
mark_as_advanced(BulletFloat_INCLUDE_DIR)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(BulletFloat REQUIRED_VARS
  BulletFloat_INCLUDE_DIR BulletFloat_BulletDynamics_LIBRARY
  BulletFloat_BulletCollision_LIBRARY BulletFloat_LinearMath_LIBRARY)

if(BulletFloat_FOUND AND NOT TARGET Bullet::Float)
  add_library(Bullet::Float INTERFACE IMPORTED)
  set_target_properties(Bullet::Float PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES ${BulletFloat_INCLUDE_DIR}
    INTERFACE_LINK_LIBRARIES "${BulletFloat_LIBRARIES}")
endif()
