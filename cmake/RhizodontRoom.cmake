# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# One room of the library: a static library rhizodont_<name> made of the sources of src/<name>.
#   rhizodont_room(<name> SOURCES a.cpp ... [USES room ...] [LINKS target ...] [PRIVATE_LINKS target ...]
#                  [APART])   # not in the shared library
function(rhizodont_room name)
  cmake_parse_arguments(ROOM "APART" "" "SOURCES;USES;LINKS;PRIVATE_LINKS" ${ARGN})
  set(target rhizodont_${name})
  add_library(${target} STATIC ${ROOM_SOURCES})
  target_include_directories(${target}
    PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>
           $<INSTALL_INTERFACE:include>
           $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src>)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_link_libraries(${target} PUBLIC Eigen3::Eigen ${ROOM_LINKS} PRIVATE ${ROOM_PRIVATE_LINKS})
  foreach(used IN LISTS ROOM_USES)
    target_link_libraries(${target} PUBLIC rhizodont_${used})
  endforeach()
  rhizodont_warnings(${target})
  if(NOT ROOM_APART)
    set_property(GLOBAL APPEND PROPERTY RHIZODONT_ROOMS ${target})
  endif()
endfunction()

function(rhizodont_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wold-style-cast
                                           -Woverloaded-virtual)
  if(RHIZODONT_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()

# The tests of one room: an executable test_<name> made of the sources in tests/<name>.
#   rhizodont_test(<name> SOURCES a.cpp ... [USES room ...] [LINKS target ...])
function(rhizodont_test name)
  cmake_parse_arguments(TEST "" "" "SOURCES;USES;LINKS" ${ARGN})
  set(target test_${name})
  add_executable(${target} ${TEST_SOURCES})
  target_link_libraries(${target} PRIVATE GTest::gtest_main ${TEST_LINKS})
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_compile_definitions(${target} PRIVATE RHIZODONT_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  foreach(used IN LISTS TEST_USES)
    target_link_libraries(${target} PRIVATE rhizodont_${used})
  endforeach()
  rhizodont_warnings(${target})
  # Compiled together, a test's local names may shadow those of the next test.
  target_compile_options(${target} PRIVATE -Wno-shadow)
  # One process per room: what tests share (weights, templates) is loaded once.
  add_test(NAME ${name} COMMAND ${target})
endfunction()
