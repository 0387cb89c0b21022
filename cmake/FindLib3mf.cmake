# LIB3MF::LIB3MF: the reference reader of 3MF files, as Debian packs it.
find_path(LIB3MF_INCLUDE_DIR Model/COM/NMR_DLLInterfaces.h PATH_SUFFIXES lib3mf)
find_library(LIB3MF_LIBRARY 3MF)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Lib3mf REQUIRED_VARS LIB3MF_LIBRARY LIB3MF_INCLUDE_DIR)
if(Lib3mf_FOUND AND NOT TARGET LIB3MF::LIB3MF)
  add_library(LIB3MF::LIB3MF UNKNOWN IMPORTED)
  set_target_properties(LIB3MF::LIB3MF PROPERTIES
    IMPORTED_LOCATION "${LIB3MF_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES "${LIB3MF_INCLUDE_DIR}")
endif()
