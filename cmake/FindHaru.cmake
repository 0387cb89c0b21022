# HARU::HARU: libharu, which writes PDF files; Debian packs no file for CMake or pkg-config with it.
find_path(HARU_INCLUDE_DIR hpdf.h)
find_library(HARU_LIBRARY hpdf)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Haru REQUIRED_VARS HARU_LIBRARY HARU_INCLUDE_DIR)
if(Haru_FOUND AND NOT TARGET HARU::HARU)
  add_library(HARU::HARU UNKNOWN IMPORTED)
  set_target_properties(HARU::HARU PROPERTIES
    IMPORTED_LOCATION "${HARU_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES "${HARU_INCLUDE_DIR}")
endif()
