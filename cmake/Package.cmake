# A package for Debian 12, by `cpack` in the build's folder; `./dev package` calls it. What is installed: app/desktop.
find_program(DPKG_PROGRAM dpkg)
if(DPKG_PROGRAM)
  execute_process(COMMAND ${DPKG_PROGRAM} --print-architecture OUTPUT_VARIABLE architecture OUTPUT_STRIP_TRAILING_WHITESPACE)
  set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE ${architecture})
endif()
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/package)
set(CPACK_PACKAGE_NAME elbowroom)
set(CPACK_PACKAGE_CONTACT "Elbowroom developers <elbowroom@localhost>" CACHE STRING "Who answers for the package, NAME <ADDRESS>")
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "tests assembly designs with real hands against virtual CAD")
set(CPACK_PACKAGE_DESCRIPTION "A few fixed cameras watch a table. From their pictures the program
reconstructs real hands and tools as a visual hull, finds where the hull
touches virtual CAD parts, measures how deep, and records it. A report says
how much space a task needs.")
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# What no file of the program is linked with: it is loaded at run time. As run_packages in `dev`.
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libegl1, libegl-mesa0, libgl1-mesa-dri, qt6-qpa-plugins, fonts-dejavu-core | fonts-liberation | fonts-liberation2, gstreamer1.0-plugins-base, gstreamer1.0-plugins-good, gstreamer1.0-plugins-bad, gstreamer1.0-libav")
# The first opens reports in a browser, the second is opened when an OpenXR headset is chosen.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "xdg-utils, libcanberra-pulse, libopenxr-loader1")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "parallel")
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/DebianChangelog.cmake)
include(CPack)
