# What `cmake --install` puts where: tools, libraries, headers, the specification of the formats, and the package for find_package(deltaz).
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/deltaz)
set_target_properties(deltaz_formats PROPERTIES EXPORT_NAME formats)
set_target_properties(deltaz_db PROPERTIES EXPORT_NAME db)
set_target_properties(deltaz_ars PROPERTIES EXPORT_NAME ars)
set_target_properties(deltaz_render PROPERTIES EXPORT_NAME render)

install(TARGETS dbbuild dbview dbcheck RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(TARGETS deltaz_formats deltaz_db deltaz_ars deltaz_render EXPORT deltazTargets DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY formats libdb librender DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/deltaz FILES_MATCHING PATTERN "*.h")
install(DIRECTORY formats/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/formats FILES_MATCHING PATTERN "*.md")
install(FILES librender/ars/words/triangle_stream.md DESTINATION ${CMAKE_INSTALL_DOCDIR}/formats)
install(FILES tools/dbcheck/report.schema.json DESTINATION ${CMAKE_INSTALL_DATADIR}/deltaz)

install(EXPORT deltazTargets NAMESPACE deltaz:: DESTINATION ${package_dir})
configure_package_config_file(cmake/deltazConfig.cmake.in ${PROJECT_BINARY_DIR}/deltazConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/deltazConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/deltazConfig.cmake ${PROJECT_BINARY_DIR}/deltazConfigVersion.cmake DESTINATION ${package_dir})
