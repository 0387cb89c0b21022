# The headers of others that nearly every file includes are parsed once for all rooms: they are two thirds of what a
# file's compilation would take. Sources still include what they use; the preset asan-ubsan compiles without precompiled
# headers and finds what a source forgot. A precompiled header fits files of the same options only, so there are several.
set(_everywhere
  <Eigen/Core> <Eigen/Geometry> <algorithm> <array> <atomic> <bit> <chrono> <cmath> <cstddef> <cstdint> <cstring> <exception>
  <filesystem> <functional> <iterator> <limits> <map> <memory> <mutex> <numbers> <numeric> <optional> <random> <set> <span>
  <sstream> <stop_token> <string> <string_view> <thread> <tuple> <type_traits> <utility> <variant> <vector> <fmt/format.h>)
set(_needed_everywhere Eigen3::Eigen fmt::fmt)

# elbowroom_precompiled(NAME header ...): a target that owns a precompiled header.
function(elbowroom_precompiled name)
  file(CONFIGURE OUTPUT ${name}.cc CONTENT "// Compiled for its precompiled header.\n")
  add_library(elbowroom_${name} OBJECT ${CMAKE_CURRENT_BINARY_DIR}/${name}.cc)
  target_link_libraries(elbowroom_${name} PRIVATE ${_needed_everywhere})
  target_precompile_headers(elbowroom_${name} PRIVATE ${ARGN})
endfunction()

if(ELBOWROOM_PRECOMPILED_HEADERS)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    add_compile_options(-fpch-preprocess)   # ccache needs it
    # Beside a precompiled <string>, GCC 12 calls copies of long literals out of bounds. The preset bench has this warning.
    target_compile_options(elbowroom_warnings INTERFACE -Wno-array-bounds)
  endif()
  elbowroom_precompiled(precompiled ${_everywhere})
  elbowroom_precompiled(precompiled_pic ${_everywhere})
  set_target_properties(elbowroom_precompiled_pic PROPERTIES POSITION_INDEPENDENT_CODE ON)
  if(ELBOWROOM_CONSOLE)
    elbowroom_precompiled(precompiled_qt ${_everywhere} <QtWidgets>)
    target_link_libraries(elbowroom_precompiled_qt PRIVATE Qt6::Widgets)
  endif()
  if(ELBOWROOM_TESTS)
    elbowroom_precompiled(precompiled_tests ${_everywhere} <gmock/gmock.h> <gtest/gtest.h>)
    target_link_libraries(elbowroom_precompiled_tests PRIVATE GTest::gtest)
  endif()
endif()

# elbowroom_use_precompiled(TARGET NAME): with what the headers in it need to be parsed alike.
function(elbowroom_use_precompiled target name)
  if(ELBOWROOM_PRECOMPILED_HEADERS)
    target_link_libraries(${target} PRIVATE ${_needed_everywhere})
    target_precompile_headers(${target} REUSE_FROM elbowroom_${name})
  endif()
endfunction()
