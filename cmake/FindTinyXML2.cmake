# TinyXML-2 (Debian: libtinyxml2-dev): target TinyXML2::TinyXML2.
find_path(TinyXML2_INCLUDE_DIR tinyxml2.h)
find_library(TinyXML2_LIBRARY tinyxml2)
mark_as_advanced(TinyXML2_INCLUDE_DIR TinyXML2_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(TinyXML2 REQUIRED_VARS TinyXML2_LIBRARY TinyXML2_INCLUDE_DIR)

if(TinyXML2_FOUND AND NOT TARGET TinyXML2::TinyXML2)
  add_library(TinyXML2::TinyXML2 INTERFACE IMPORTED)
  set_target_properties(TinyXML2::TinyXML2 PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES ${TinyXML2_INCLUDE_DIR}
    INTERFACE_LINK_LIBRARIES ${TinyXML2_LIBRARY})
endif()
