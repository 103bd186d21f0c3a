# cmake --install: headers, static libraries and a package that find_package(piperun) finds.
include(CMakePackageConfigHelpers)
get_property(floors GLOBAL PROPERTY PIPERUN_FLOORS)
list(TRANSFORM floors PREPEND piperun_ OUTPUT_VARIABLE targets)
install(TARGETS ${targets} EXPORT piperunTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
foreach(floor IN LISTS floors)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${floor} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/piperun
    FILES_MATCHING PATTERN "*.h" PATTERN "bullet" EXCLUDE)
endforeach()
install(EXPORT piperunTargets NAMESPACE piperun:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/piperun)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/piperunConfig.cmake.in
  ${PROJECT_BINARY_DIR}/piperunConfig.cmake INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/piperun)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/piperunConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/piperunConfig.cmake ${PROJECT_BINARY_DIR}/piperunConfigVersion.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/piperun)
if(TARGET piperun)
  install(TARGETS piperun RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
