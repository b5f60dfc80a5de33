# SPDX-License-Identifier: MIT
# OpenCV's core, imgproc, imgcodecs and calib3d as imported targets. Debian packages them one by one, but
# OpenCVConfig.cmake only with all of OpenCV.
include(FindPackageHandleStandardArgs)
find_path(OpenCVSome_INCLUDE opencv2/core.hpp PATH_SUFFIXES opencv4)
foreach(part core imgproc imgcodecs calib3d)
  find_library(OpenCVSome_${part} opencv_${part})
  list(APPEND OpenCVSome_needed OpenCVSome_${part})
endforeach()
find_package_handle_standard_args(OpenCVSome DEFAULT_MSG OpenCVSome_INCLUDE ${OpenCVSome_needed})
foreach(part core imgproc imgcodecs calib3d)
  if(OpenCVSome_FOUND AND NOT TARGET opencv_${part})
    add_library(opencv_${part} UNKNOWN IMPORTED)
    set_target_properties(opencv_${part} PROPERTIES
      IMPORTED_LOCATION "${OpenCVSome_${part}}" INTERFACE_INCLUDE_DIRECTORIES "${OpenCVSome_INCLUDE}")
  endif()
endforeach()
