# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# cmake -DBUILD=<build folder> -DSOURCE=<source folder> -P run.cmake: installs below the build folder, builds the
# consumer against what was installed, and runs it away from the source tree's models.
set(prefix ${BUILD}/consumer/prefix)
file(REMOVE_RECURSE ${BUILD}/consumer)
foreach(command
    "${CMAKE_COMMAND};--install;${BUILD};--prefix;${prefix}"
    "${CMAKE_COMMAND};-S;${SOURCE}/tests/consumer;-B;${BUILD}/consumer/build;-G;Ninja;-DCMAKE_PREFIX_PATH=${prefix}"
    "${CMAKE_COMMAND};--build;${BUILD}/consumer/build"
    "${BUILD}/consumer/build/consumer;${SOURCE}/samples/crown_36.stl")
  execute_process(COMMAND ${command} RESULT_VARIABLE result OUTPUT_VARIABLE text ERROR_VARIABLE text)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${command} ended with ${result}:\n${text}")
  endif()
endforeach()
message(STATUS "${text}")
