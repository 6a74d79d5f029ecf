# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# Debian packages, made by `cpack` in the build folder: rhizodont (program with the page), rhizodont-models, librhizodont0,
# librhizodont-dev, python3-rhizodont.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "Rhizodont contributors <rhizodont@example.org>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR})

set(CPACK_COMPONENTS_ALL program models library development)
set(same "(= ${PROJECT_VERSION})")
set(notice "A predicted root is typical for such a crown, not the patient's anatomy: for research and visualisation only.")

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME rhizodont)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "rhizodont-models ${same}")
# The first line of each description is the project's.
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION
    "The program: complete, arch, segment, batch, check, measure, render, evaluate, synth and doctor; and a local\n page (rhizodont serve). ${notice}")

set(CPACK_DEBIAN_MODELS_PACKAGE_NAME rhizodont-models)
set(CPACK_DEBIAN_MODELS_PACKAGE_SECTION science)
set(CPACK_DEBIAN_MODELS_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_MODELS_PACKAGE_SHLIBDEPS OFF)
set(CPACK_COMPONENT_MODELS_DESCRIPTION "Weights and mean teeth, each file with a card that says what it was made of.")

set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME librhizodont${PROJECT_VERSION_MAJOR})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS "rhizodont-models ${same}")
file(WRITE ${PROJECT_BINARY_DIR}/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/triggers)
set(CPACK_COMPONENT_LIBRARY_DESCRIPTION "The shared library. ${notice}")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME librhizodont-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "librhizodont${PROJECT_VERSION_MAJOR} ${same}, libeigen3-dev")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "Headers and CMake files of the library, for find_package(Rhizodont).")

if(RHIZODONT_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-rhizodont)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
      "librhizodont${PROJECT_VERSION_MAJOR} ${same}, python3 (>= 3.11), python3 (<< 3.12), python3-numpy")
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION "The Python module. ${notice}")
endif()

# Every package says under which licence it stands.
set(copyright ${PROJECT_BINARY_DIR}/copyright)
configure_file(cmake/copyright.in ${copyright} COPYONLY)
foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  string(TOUPPER ${component} upper)
  install(FILES ${copyright} DESTINATION share/doc/${CPACK_DEBIAN_${upper}_PACKAGE_NAME} COMPONENT ${component})
endforeach()
include(CPack)
