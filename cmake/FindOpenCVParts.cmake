# Finds the OpenCV modules in use without libopencv-dev, which pulls in 670 MB of modules that are not. Further
# modules, which only some folders need, are asked for as components.
find_path(OpenCVParts_INCLUDE_DIR opencv2/core.hpp PATH_SUFFIXES opencv4 REQUIRED)
set(_opencv_required OpenCVParts_INCLUDE_DIR)
foreach(_module core imgproc imgcodecs videoio calib3d aruco ${OpenCVParts_FIND_COMPONENTS})
  find_library(OpenCVParts_${_module}_LIBRARY opencv_${_module} REQUIRED)
  list(APPEND _opencv_required OpenCVParts_${_module}_LIBRARY)
  if(NOT TARGET OpenCVParts::${_module})
    add_library(OpenCVParts::${_module} UNKNOWN IMPORTED)
    set_target_properties(OpenCVParts::${_module} PROPERTIES
      IMPORTED_LOCATION ${OpenCVParts_${_module}_LIBRARY}
      INTERFACE_INCLUDE_DIRECTORIES ${OpenCVParts_INCLUDE_DIR})
  endif()
endforeach()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenCVParts REQUIRED_VARS ${_opencv_required})
