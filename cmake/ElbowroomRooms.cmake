# The two shapes every folder is built from: a room (a static library) and a test program.

# elbowroom_room(NAME SOURCES a.cc ... USES target ... HIDES target ...)
# USES: libraries that may appear in the room's headers. HIDES: libraries only its .cc files include.
function(elbowroom_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;USES;HIDES" ${ARGN})
  add_library(elbowroom_${name} STATIC ${ROOM_SOURCES})
  target_include_directories(elbowroom_${name} PUBLIC ${PROJECT_SOURCE_DIR})
  target_link_libraries(elbowroom_${name} PUBLIC ${ROOM_USES} PRIVATE ${ROOM_HIDES} elbowroom_warnings)
endfunction()

# elbowroom_test(NAME SOURCES a_test.cc ... USES target ... [LABELS gl ...] [IMPORTS])
# IMPORTS: it reads CAD files, so its main serves as the child that does.
function(elbowroom_test name)
  cmake_parse_arguments(TEST "IMPORTS" "" "SOURCES;USES;LABELS" ${ARGN})
  add_executable(${name} ${TEST_SOURCES})
  target_link_libraries(${name} PRIVATE ${TEST_USES} GTest::gtest GTest::gtest_main elbowroom_warnings)
  if(TEST_IMPORTS)
    target_sources(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests/support/importing_main.cc)
    target_link_libraries(${name} PRIVATE elbowroom_cad_import)
  endif()
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_compile_definitions(${name} PRIVATE
    ELBOWROOM_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
    ELBOWROOM_SHARED_DATA_DIR="${PROJECT_SOURCE_DIR}/../shared/data"
    ELBOWROOM_PROGRAM="${PROJECT_BINARY_DIR}/elbowroom")
  include(GoogleTest)
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST PROPERTIES LABELS "${TEST_LABELS}")
endfunction()

add_library(elbowroom_warnings INTERFACE)
target_compile_options(elbowroom_warnings INTERFACE -Wall -Wextra -Wshadow -Wconversion)
if(ELBOWROOM_WERROR)
  target_compile_options(elbowroom_warnings INTERFACE -Werror)
endif()
