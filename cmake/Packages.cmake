# The Debian packages, made by CPack: cmake --build --preset release && cpack --config build/release/CPackConfig.cmake
# The version of a package is the project's; cpack -D CPACK_DEBIAN_PACKAGE_VERSION=... gives another one.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME homing)
set(CPACK_PACKAGE_CONTACT "The Homing authors <maintainers@homing.invalid>")
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_COMPONENTS_ALL)

set(full_version ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})
string(TIMESTAMP now "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(WRITE ${PROJECT_BINARY_DIR}/documents/changelog.Debian
  "homing (${full_version}) unstable; urgency=medium\n\n  * Release ${PROJECT_VERSION}: see CHANGELOG.md of the sources.\n\n"
  " -- ${CPACK_PACKAGE_CONTACT}  ${now}\n")
execute_process(COMMAND gzip -9nf ${PROJECT_BINARY_DIR}/documents/changelog.Debian)

# homing_package(COMPONENT NAME SECTION SUMMARY LINE...): one package.
macro(homing_package component name section summary)
  set(lines ${ARGN})
  list(JOIN lines "\n" lines)
  string(TOUPPER ${component} upper)
  list(APPEND CPACK_COMPONENTS_ALL ${component})
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name})
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${section})
  set(CPACK_COMPONENT_${upper}_DESCRIPTION "${summary}\n${lines}")
  install(FILES ${PROJECT_SOURCE_DIR}/deploy/debian/copyright ${PROJECT_BINARY_DIR}/documents/changelog.Debian.gz
    DESTINATION share/doc/${name} COMPONENT ${component})
endmacro()

homing_package(server homing-server net "localisation server for robots"
  "Robots stream frames or optical flow; the server keeps a few bytes a place"
  "and reports to a robot on its way home which place of its route it sees."
  "The service has a user of its own and listens on this machine until it has"
  "certificates. Purging the package deletes the recorded journeys.")
set(CPACK_DEBIAN_SERVER_PACKAGE_DEPENDS adduser)
set(CPACK_DEBIAN_SERVER_PACKAGE_SUGGESTS homing)
file(GLOB CPACK_DEBIAN_SERVER_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/deploy/debian/server/*)

homing_package(client homing net "records and recognises a robot's way by optical flow"
  "The command homing records journeys on a homing-server from image folders,"
  "videos and cameras, and localises on the way home. It also keeps, draws and"
  "judges the maps, and simulates a robot.")
set(CPACK_DEBIAN_CLIENT_PACKAGE_SUGGESTS homing-server)

homing_package(tools homing-tools net "load generator for homing-server"
  "The command homing-bench drives many simulated robots against a server and"
  "reports throughput and latencies.")

homing_package(lib libhoming libs "robot's side of Homing, shared library"
  "Records journeys on a homing-server and localises on the way home."
  "Observations wait in a bounded file on the robot while the link is down.")
file(GLOB CPACK_DEBIAN_LIB_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/deploy/debian/lib/*)

homing_package(dev libhoming-dev libdevel "robot's side of Homing, headers"
  "Headers, CMake package and pkg-config file of libhoming, with an example.")
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "libhoming (= ${full_version})")

if(HOMING_PYTHON)
  homing_package(python python3-homing python "robot's side of Homing, Python package"
    "Records journeys on a homing-server and localises on the way home, from numpy"
    "images or optical flow, with and without asyncio. The command homing-vda5050"
    "turns answers into fragments of VDA 5050 state messages.")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_ARCHITECTURE all)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS OFF)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.9), python3-grpcio, python3-numpy, python3-protobuf")
  file(GLOB CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/deploy/debian/python/*)
endif()

include(CPack)
