# OpenCV's CMake files are only in Debian's libopencv-dev (745 MB); the single -dev packages suffice.
find_path(OPENCV_INCLUDE_DIR opencv2/core.hpp PATH_SUFFIXES opencv4 REQUIRED)
function(homing_opencv_module module)
  find_library(OPENCV_${module}_LIBRARY opencv_${module} ${ARGN})
  if(OPENCV_${module}_LIBRARY)
    add_library(OpenCV::${module} SHARED IMPORTED GLOBAL)
    set_target_properties(OpenCV::${module} PROPERTIES
      IMPORTED_LOCATION ${OPENCV_${module}_LIBRARY}
      INTERFACE_INCLUDE_DIRECTORIES ${OPENCV_INCLUDE_DIR}
      INTERFACE_SYSTEM_INCLUDE_DIRECTORIES ${OPENCV_INCLUDE_DIR})
  endif()
endfunction()
homing_opencv_module(core REQUIRED)
homing_opencv_module(imgproc REQUIRED)
homing_opencv_module(video REQUIRED)
homing_opencv_module(imgcodecs)
homing_opencv_module(videoio)
