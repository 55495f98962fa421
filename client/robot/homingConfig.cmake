# find_package(homing) defines the target homing::client.
include(${CMAKE_CURRENT_LIST_DIR}/homingTargets.cmake)
