# What others link: models/ and hw/ with their headers, as the CMake package "quadrille" (examples/).
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/quadrille)
set_target_properties(quadrille_models PROPERTIES EXPORT_NAME models)
set_target_properties(quadrille_hw PROPERTIES EXPORT_NAME hw)
install(TARGETS quadrille_models quadrille_hw quadrille_systemc quadrille_warnings EXPORT quadrille)
install(EXPORT quadrille FILE quadrilleTargets.cmake NAMESPACE quadrille:: DESTINATION ${package_folder})
install(DIRECTORY models hw DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/quadrille FILES_MATCHING PATTERN "*.h" PATTERN reference EXCLUDE)
configure_package_config_file(cmake/quadrilleConfig.cmake.in quadrilleConfig.cmake INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(quadrilleConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/quadrilleConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/quadrilleConfigVersion.cmake
        DESTINATION ${package_folder})
