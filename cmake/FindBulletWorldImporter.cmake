# Bullet's reader of .bullet files in double precision (Debian: libbullet-extras-dev): target
# Bullet::WorldImporter.
find_package(BulletDouble QUIET)
find_path(BulletWorldImporter_INCLUDE_DIR BulletWorldImporter/btBulletWorldImporter.h
  PATH_SUFFIXES bullet)
foreach(part BulletWorldImporter BulletFileLoader)
  find_library(BulletWorldImporter_${part}_LIBRARY ${part}-float64)
  list(APPEND BulletWorldImporter_LIBRARIES ${BulletWorldImporter_${part}_LIBRARY})
  mark_as_advanced(BulletWorldImporter_${part}_LIBRARY)
endforeach()
mark_as_advanced(BulletWorldImporter_INCLUDE_DIR)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(BulletWorldImporter REQUIRED_VARS
  BulletWorldImporter_INCLUDE_DIR BulletWorldImporter_BulletWorldImporter_LIBRARY
  BulletWorldImporter_BulletFileLoader_LIBRARY BulletDouble_FOUND)

if(BulletWorldImporter_FOUND AND NOT TARGET Bullet::WorldImporter)
  add_library(Bullet::WorldImporter INTERFACE IMPORTED)
  set_target_properties(Bullet::WorldImporter PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES ${BulletWorldImporter_INCLUDE_DIR}
    INTERFACE_LINK_LIBRARIES "${BulletWorldImporter_LIBRARIES};Bullet::Double")
endif()
