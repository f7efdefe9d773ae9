# SPDX-License-Identifier: Apache-2.0
# What `cmake --install` lays down: the core's headers and static libraries, and the descriptions that let
# find_package(touchline) and pkg-config find them. Both can be moved to another prefix after the install.
include(CMakePackageConfigHelpers)
set(TOUCHLINE_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/touchline)

# The executable is called touchline too, so the target has another name here than for users.
add_library(touchline_all INTERFACE)
set_target_properties(touchline_all PROPERTIES EXPORT_NAME touchline)
target_link_libraries(touchline_all INTERFACE ${TOUCHLINE_CORE_LIBRARIES})
add_library(touchline::touchline ALIAS touchline_all)

set(pkgconfig_libraries)
foreach(library IN LISTS TOUCHLINE_CORE_LIBRARIES)
  string(REPLACE "touchline_" "" part ${library})
  set_target_properties(${library} PROPERTIES EXPORT_NAME ${part})
  list(PREPEND pkgconfig_libraries -l${library})  # the linker wants users before what they use
endforeach()
list(JOIN pkgconfig_libraries " " TOUCHLINE_PKGCONFIG_LIBRARIES)

install(TARGETS touchline_all ${TOUCHLINE_CORE_LIBRARIES} EXPORT touchline ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT touchline NAMESPACE touchline:: FILE touchlineTargets.cmake DESTINATION ${TOUCHLINE_CMAKE_DIR})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/touchlineConfig.cmake.in
  ${PROJECT_BINARY_DIR}/touchlineConfig.cmake INSTALL_DESTINATION ${TOUCHLINE_CMAKE_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/touchlineConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/touchlineConfig.cmake ${PROJECT_BINARY_DIR}/touchlineConfigVersion.cmake
  DESTINATION ${TOUCHLINE_CMAKE_DIR})

file(RELATIVE_PATH TOUCHLINE_PREFIX_FROM_PC /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(${CMAKE_CURRENT_LIST_DIR}/touchline.pc.in ${PROJECT_BINARY_DIR}/touchline.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/touchline.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

# The tree as it is, so that "vision/pipeline.h" means the same file for us and for the user.
foreach(room platform/core platform/processor platform/robot vision loc)
  get_filename_component(parent ${room} DIRECTORY)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${room} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/touchline/${parent}
    FILES_MATCHING PATTERN "*.h")
endforeach()
install(FILES ${PROJECT_SOURCE_DIR}/platform/touchline.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/touchline)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/hal DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/touchline
  FILES_MATCHING PATTERN "*.h" PATTERN "linux" EXCLUDE)
if(TARGET touchline)
  install(TARGETS touchline RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
