# cmake --install: the binary, the floors' static libraries, their public headers, and a package that
# find_package(piperun) finds. What the package must find in turn is read from the link lines.

# piperun_linked_packages(PACKAGES MODULES TARGETS...): the CMake packages and pkg-config modules that stand in
# the link lines of the targets, as `Package::name` and `PkgConfig::prefix`.
function(piperun_linked_packages packages_out modules_out)
  set(packages)
  set(modules)
  foreach(target IN LISTS ARGN)
    get_target_property(libraries ${target} LINK_LIBRARIES)
    foreach(library IN LISTS libraries)
      if(library MATCHES "^PkgConfig::(.+)$")
        list(APPEND modules ${${CMAKE_MATCH_1}_MODULE_NAME})
      elseif(library MATCHES "^([A-Za-z0-9_]+)::" AND NOT CMAKE_MATCH_1 STREQUAL "piperun")
        list(APPEND packages ${CMAKE_MATCH_1})
      endif()
    endforeach()
  endforeach()
  list(REMOVE_DUPLICATES packages)
  list(REMOVE_DUPLICATES modules)
  set(${packages_out} ${packages} PARENT_SCOPE)
  set(${modules_out} ${modules} PARENT_SCOPE)
endfunction()

include(CMakePackageConfigHelpers)
get_property(floors GLOBAL PROPERTY PIPERUN_FLOORS)
list(TRANSFORM floors PREPEND piperun_ OUTPUT_VARIABLE targets)
install(TARGETS ${targets} EXPORT piperunTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
# A floor's public headers stand at its top; its folders are private, but for the hydraulics of networks.
set(header_folders ${floors})
if(sim IN_LIST floors)
  list(APPEND header_folders sim/network)
endif()
foreach(floor IN LISTS header_folders)
  file(GLOB headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${floor}/*.h)
  install(FILES ${headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/piperun/${floor})
endforeach()
if(TARGET piperun)
  install(TARGETS piperun RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/piperun)
piperun_linked_packages(PIPERUN_PACKAGES PIPERUN_MODULES ${targets})
install(EXPORT piperunTargets NAMESPACE piperun:: DESTINATION ${package_folder})
set(piperun_include ${CMAKE_INSTALL_INCLUDEDIR}/piperun)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/piperunConfig.cmake.in
  ${PROJECT_BINARY_DIR}/piperunConfig.cmake INSTALL_DESTINATION ${package_folder} PATH_VARS piperun_include)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/piperunConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/piperunConfig.cmake ${PROJECT_BINARY_DIR}/piperunConfigVersion.cmake
  DESTINATION ${package_folder})
