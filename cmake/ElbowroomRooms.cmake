# The shapes every folder is built from: a room (a static library), a module (loaded when it is first needed) and a
# test program.

# Highway compiles a kernel several times, so a kernel can't share a compilation with other files (a unity build).
function(elbowroom_compile_kernels_alone)
  foreach(source ${ARGN})
    get_source_file_property(is_generated ${source} GENERATED)
    if(is_generated)
      continue()   # not written yet
    endif()
    file(STRINGS ${source} is_kernel REGEX "include [<\"]hwy/foreach_target.h")
    if(is_kernel)
      set_source_files_properties(${source} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    endif()
  endforeach()
endfunction()

# elbowroom_room(NAME [IN_MODULES] [PRECOMPILED header] SOURCES a.cc ... USES target ... HIDES target ...)
# USES: libraries that may appear in the room's headers. HIDES: libraries only its .cc files include. IN_MODULES: modules
# are linked from it, so it is compiled as position-independent code. PRECOMPILED: another precompiled header than the
# one that rooms share (PrecompiledHeaders.cmake).
function(elbowroom_room name)
  cmake_parse_arguments(ROOM "IN_MODULES" "PRECOMPILED" "SOURCES;USES;HIDES" ${ARGN})
  add_library(elbowroom_${name} STATIC ${ROOM_SOURCES})
  elbowroom_compile_kernels_alone(${ROOM_SOURCES})
  if(ROOM_IN_MODULES)
    set_target_properties(elbowroom_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    elbowroom_use_precompiled(elbowroom_${name} precompiled_pic)
  elseif(ROOM_PRECOMPILED)
    elbowroom_use_precompiled(elbowroom_${name} ${ROOM_PRECOMPILED})
  else()
    elbowroom_use_precompiled(elbowroom_${name} precompiled)
  endif()
  target_include_directories(elbowroom_${name} PUBLIC ${PROJECT_SOURCE_DIR})
  target_link_libraries(elbowroom_${name} PUBLIC ${ROOM_USES} PRIVATE ${ROOM_HIDES} elbowroom_warnings)
endfunction()

# elbowroom_rooms(NAME room ...): several rooms by one name.
function(elbowroom_rooms name)
  list(TRANSFORM ARGN PREPEND elbowroom_)
  add_library(elbowroom_${name} INTERFACE)
  target_link_libraries(elbowroom_${name} INTERFACE ${ARGN})
endfunction()

# elbowroom_module(NAME SOURCES a.cc ... HIDES target ...)
# What core/system/module.h finds by NAME. Rooms that go into it are IN_MODULES.
function(elbowroom_module name)
  cmake_parse_arguments(MODULE "" "" "SOURCES;HIDES" ${ARGN})
  add_library(elbowroom_${name}_module MODULE ${MODULE_SOURCES})
  target_include_directories(elbowroom_${name}_module PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(elbowroom_${name}_module PRIVATE ${MODULE_HIDES} elbowroom_warnings)
  elbowroom_use_precompiled(elbowroom_${name}_module precompiled_pic)
  target_link_options(elbowroom_${name}_module PRIVATE LINKER:--exclude-libs,ALL)
  set_target_properties(elbowroom_${name}_module PROPERTIES
    OUTPUT_NAME "elbowroom_${name}-${PROJECT_VERSION}" LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
  set_property(GLOBAL APPEND PROPERTY ELBOWROOM_MODULES elbowroom_${name}_module)
endfunction()

# elbowroom_finds_modules(EXECUTABLE FOLDER): built with the modules, which it finds in FOLDER ("$ORIGIN": its own).
# By DT_RPATH: AddressSanitizer stands between dlopen and a DT_RUNPATH.
function(elbowroom_finds_modules executable folder)
  set_target_properties(${executable} PROPERTIES BUILD_RPATH "${folder}" INSTALL_RPATH "${folder}")
  target_link_options(${executable} PRIVATE LINKER:--disable-new-dtags)
  get_property(modules GLOBAL PROPERTY ELBOWROOM_MODULES)
  add_dependencies(${executable} ${modules})
endfunction()

# elbowroom_child_program(NAME SOURCE USES target ...)
# A program that core/system/module.h finds by NAME among the modules: it is built with them, and finds them beside it.
function(elbowroom_child_program name source)
  cmake_parse_arguments(PROGRAM "" "" "USES" ${ARGN})
  add_executable(elbowroom_${name} ${source})
  target_link_libraries(elbowroom_${name} PRIVATE ${PROGRAM_USES} elbowroom_warnings)
  set_target_properties(elbowroom_${name} PROPERTIES
    OUTPUT_NAME "elbowroom_${name}-${PROJECT_VERSION}" RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
  elbowroom_finds_modules(elbowroom_${name} "$ORIGIN")
  set_property(GLOBAL APPEND PROPERTY ELBOWROOM_MODULES elbowroom_${name})
endfunction()

# elbowroom_test(NAME SOURCES a_test.cc ... USES target ... [LABELS gl ...] [IMPORTS] [PRECOMPILED header] [TOGETHER suite ...])
# IMPORTS: it reads CAD files, so its main serves as the child that does.
# TOGETHER: suites whose tests share what takes long to make. Each suite is one test of CTest; no test of it may be skipped.
function(elbowroom_test name)
  cmake_parse_arguments(TEST "IMPORTS;ALONE" "PRECOMPILED" "SOURCES;USES;LABELS;TOGETHER" ${ARGN})
  add_executable(${name} ${TEST_SOURCES})
  if(TEST_PRECOMPILED)
    elbowroom_use_precompiled(${name} ${TEST_PRECOMPILED})
  else()
    elbowroom_use_precompiled(${name} precompiled_tests)
  endif()
  target_link_libraries(${name} PRIVATE ${TEST_USES} elbowroom_test_places GTest::gtest GTest::gtest_main elbowroom_warnings)
  if(TEST_IMPORTS)
    target_sources(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests/support/importing_main.cc)
    target_link_libraries(${name} PRIVATE elbowroom_cad_import)
  endif()
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  elbowroom_finds_modules(${name} ${PROJECT_BINARY_DIR})
  include(GoogleTest)
  set(properties LABELS "${TEST_LABELS}")
  if(TEST_ALONE)
    list(APPEND properties RUN_SERIAL TRUE)
  endif()
  set(one_by_one "*")
  if(TEST_TOGETHER)
    list(TRANSFORM TEST_TOGETHER APPEND ".*" OUTPUT_VARIABLE together)
    list(JOIN together ":" together)
    set(one_by_one "-${together}")
  endif()
  foreach(suite IN LISTS TEST_TOGETHER)
    add_test(NAME ${suite} COMMAND ${name} "--gtest_filter=${suite}.*")
    set_tests_properties(${suite} PROPERTIES LABELS "${TEST_LABELS}" RUN_SERIAL "${TEST_ALONE}")
  endforeach()
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST TEST_FILTER "${one_by_one}" PROPERTIES ${properties})
endfunction()

add_library(elbowroom_warnings INTERFACE)
target_compile_options(elbowroom_warnings INTERFACE -Wall -Wextra -Wshadow -Wconversion)
if(ELBOWROOM_WERROR)
  target_compile_options(elbowroom_warnings INTERFACE -Werror)
endif()
