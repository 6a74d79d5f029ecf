# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# One shared library with all rooms: what `find_package(Rhizodont)` gives. Its public headers need Eigen alone; CGAL
# and the others stay inside.
include(GNUInstallDirs)
include(GenerateExportHeader)
include(CMakePackageConfigHelpers)

get_property(rooms GLOBAL PROPERTY RHIZODONT_ROOMS)
set(room_objects "")
foreach(room IN LISTS rooms)
  list(APPEND room_objects $<TARGET_OBJECTS:${room}>)
endforeach()
add_library(rhizodont_library SHARED ${room_objects})
set_target_properties(rhizodont_library PROPERTIES
  OUTPUT_NAME rhizodont EXPORT_NAME rhizodont
  VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR})
generate_export_header(rhizodont_library BASE_NAME RHIZODONT
  EXPORT_FILE_NAME ${CMAKE_CURRENT_BINARY_DIR}/include/rhizodont/export.hpp)
target_link_libraries(rhizodont_library
  PUBLIC Eigen3::Eigen
  PRIVATE ${rooms})
target_include_directories(rhizodont_library INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_compile_features(rhizodont_library INTERFACE cxx_std_20)

install(TARGETS rhizodont_library EXPORT RhizodontTargets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_COMPONENT development)
set(RHIZODONT_ZSH_DIR ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions CACHE STRING
    "Where zsh looks for completions, below the prefix: Debian's place for packages; site-functions elsewhere")
rhizodont_install_program(rhizodont program)
if(RHIZODONT_TRAINING)
  # The folder of the BLAS that torch needs, see src/learning/CMakeLists.txt.
  set_target_properties(rhizodont-train PROPERTIES INSTALL_RPATH_USE_LINK_PATH ON)
  rhizodont_install_program(rhizodont-train training)
endif()
install(DIRECTORY include/rhizodont ${CMAKE_CURRENT_BINARY_DIR}/include/rhizodont
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development FILES_MATCHING PATTERN "*.hpp")
install(DIRECTORY models/ DESTINATION ${CMAKE_INSTALL_DATADIR}/rhizodont/models COMPONENT models)
install(DIRECTORY samples/ DESTINATION ${CMAKE_INSTALL_DATADIR}/rhizodont/samples COMPONENT program)
install(EXPORT RhizodontTargets NAMESPACE Rhizodont:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Rhizodont
  COMPONENT development)
configure_package_config_file(cmake/RhizodontConfig.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/RhizodontConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Rhizodont)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/RhizodontConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/RhizodontConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/RhizodontConfigVersion.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Rhizodont COMPONENT development)

# What software centres and menus show.
set(identity org.rhizodont.Rhizodont)
install(FILES deploy/${identity}.metainfo.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/metainfo COMPONENT program)
install(FILES deploy/${identity}.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications COMPONENT program)
install(FILES deploy/${identity}.svg DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps COMPONENT program)
