# Every third-party package, found once; each is linked only by the room it belongs to (docs/architecture.md).
find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(TBB REQUIRED)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(SQLiteCpp REQUIRED)
find_package(assimp REQUIRED)
find_package(OpenCASCADE REQUIRED)   # its version file knows no "or newer"
find_package(meshoptimizer REQUIRED)
find_package(Boost REQUIRED)   # its headers
find_package(CGAL REQUIRED)
find_package(fcl 0.7 REQUIRED)
find_package(GTest REQUIRED)
pkg_check_modules(EPOXY REQUIRED IMPORTED_TARGET epoxy)
pkg_check_modules(HIGHWAY REQUIRED IMPORTED_TARGET libhwy libhwy-contrib)
pkg_check_modules(ZSTD REQUIRED IMPORTED_TARGET libzstd)
pkg_check_modules(XXHASH REQUIRED IMPORTED_TARGET libxxhash)
pkg_check_modules(ARAVIS REQUIRED IMPORTED_TARGET aravis-0.8)
pkg_check_modules(GSTREAMER REQUIRED IMPORTED_TARGET gstreamer-1.0 gstreamer-app-1.0 gstreamer-video-1.0)
pkg_check_modules(TURBOJPEG REQUIRED IMPORTED_TARGET libturbojpeg)
pkg_check_modules(LIBZIP REQUIRED IMPORTED_TARGET libzip)  # its own config file asks for its tools
find_package(pugixml REQUIRED)
find_path(FCCP_HEADERS libfccp/csv.h REQUIRED)       # on the default path; a header alone
find_path(OPENXR_HEADERS openxr/openxr.h REQUIRED)   # on the default path; its loader is opened when it is needed
pkg_check_modules(CANBERRA REQUIRED IMPORTED_TARGET libcanberra)
pkg_check_modules(DUKTAPE REQUIRED IMPORTED_TARGET duktape)
pkg_check_modules(CAIRO REQUIRED IMPORTED_TARGET cairo-pdf)
pkg_check_modules(PANGO REQUIRED IMPORTED_TARGET pangocairo)
pkg_check_modules(RSVG REQUIRED IMPORTED_TARGET librsvg-2.0)
# They bundle the scripts of pages, from npm packages.
find_program(NODE_PROGRAM NAMES node nodejs REQUIRED)
find_program(NPM_PROGRAM npm REQUIRED)
if(ELBOWROOM_TESTS)
  pkg_check_modules(GSTREAMER_RTSP_SERVER REQUIRED IMPORTED_TARGET gstreamer-rtsp-server-1.0 gstreamer-app-1.0)
  set_target_properties(PkgConfig::GSTREAMER_RTSP_SERVER PROPERTIES INTERFACE_COMPILE_OPTIONS "")
endif()
# Without -pthread and -D_REENTRANT, which precompiled headers lack.
set_target_properties(PkgConfig::ARAVIS PkgConfig::CANBERRA PkgConfig::GSTREAMER PkgConfig::PANGO PkgConfig::RSVG PROPERTIES INTERFACE_COMPILE_OPTIONS "")
find_package(Lib3mf REQUIRED)        # its pkg-config file asks for the static libraries of others
find_package(Haru REQUIRED)
find_package(OpenCVParts REQUIRED)   # only the modules in use; Debian ships no CMake config for single modules
if(ELBOWROOM_CONSOLE)
  find_package(Qt6 REQUIRED COMPONENTS Widgets Test)
  # Each test's source folder, which no test asks for: without it the compiler's cache serves every clone.
  get_target_property(definitions Qt6::Test INTERFACE_COMPILE_DEFINITIONS)
  list(FILTER definitions EXCLUDE REGEX "^QT_TESTCASE_")
  set_target_properties(Qt6::Test PROPERTIES INTERFACE_COMPILE_DEFINITIONS "${definitions}")
endif()

# The readers of STEP, IGES and BREP, and what they need to mesh; OpenCASCADE's targets carry no include folder of their own.
add_library(elbowroom_opencascade_headers INTERFACE)
target_include_directories(elbowroom_opencascade_headers SYSTEM INTERFACE ${OpenCASCADE_INCLUDE_DIR})
add_library(elbowroom_opencascade INTERFACE)
target_link_libraries(elbowroom_opencascade INTERFACE elbowroom_opencascade_headers
  TKXDESTEP TKXDEIGES TKSTEP TKSTEP209 TKSTEPAttr TKSTEPBase TKIGES TKXSBase TKXCAF TKVCAF TKLCAF TKCAF TKCDF TKMesh TKShHealing
  TKTopAlgo TKGeomAlgo TKBRep TKGeomBase TKG3d TKG2d TKMath TKernel)
