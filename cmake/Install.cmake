# What `cmake --install` and the Debian package hold: the program with its manual page and completions, the scenarios and
# the documentation; and the rooms as libraries with their headers, for find_package(glidelab).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# The manual page and the completions are what the program says of itself.
set(texts ${CMAKE_BINARY_DIR}/texts)
add_custom_command(
  OUTPUT ${texts}/glidelab.1.gz ${texts}/glidelab.bash ${texts}/_glidelab
  COMMAND ${CMAKE_COMMAND} -E make_directory ${texts}
  COMMAND $<TARGET_FILE:glidelab> --man > ${texts}/glidelab.1
  COMMAND gzip -9nf ${texts}/glidelab.1
  COMMAND $<TARGET_FILE:glidelab> --completion bash > ${texts}/glidelab.bash
  COMMAND $<TARGET_FILE:glidelab> --completion zsh > ${texts}/_glidelab
  DEPENDS glidelab
  VERBATIM)
add_custom_target(texts ALL DEPENDS ${texts}/glidelab.1.gz ${texts}/glidelab.bash ${texts}/_glidelab)

# The pages and worksheets for class, which need no build, are made anew where they lie; a test says when that is due.
set(class ${CMAKE_CURRENT_SOURCE_DIR}/docs/class)
add_custom_target(
  class_pages
  COMMAND glidelab explore --quiet --out ${class}
  COMMAND glidelab laws ${CMAKE_CURRENT_SOURCE_DIR}/scenarios/laws --quiet --out ${class}
  COMMAND glidelab laws ${CMAKE_CURRENT_SOURCE_DIR}/scenarios/laws --worksheet --quiet --out ${class}/worksheets
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${class}/plots
  VERBATIM)

install(TARGETS glidelab)
install(FILES ${texts}/glidelab.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${texts}/glidelab.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME glidelab)
install(FILES ${texts}/_glidelab DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
install(DIRECTORY scenarios DESTINATION ${CMAKE_INSTALL_DATADIR}/glidelab)
install(FILES README.md CHANGELOG.md CONVENTIONS.md CONTRIBUTING.md LICENSE CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright)  # where Debian looks for it
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} FILES_MATCHING PATTERN "*.md" PATTERN "*.png" PATTERN "*.svg"
        PATTERN "*.schema.json" PATTERN "*.html" PATTERN "*.pdf")
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DOCDIR} PATTERN "__pycache__" EXCLUDE)

set(package ${CMAKE_INSTALL_LIBDIR}/cmake/glidelab)
install(TARGETS glidelab_motion EXPORT glidelab ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}/glidelab)  # its headers are core's
set_target_properties(glidelab_motion PROPERTIES EXPORT_NAME motion)
foreach(room base sim core render fit diagnose validate report teach)
  set_target_properties(glidelab_${room} PROPERTIES EXPORT_NAME ${room})
  install(TARGETS glidelab_${room} EXPORT glidelab ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}/glidelab)
  install(DIRECTORY ${room} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/glidelab FILES_MATCHING PATTERN "*.h")
endforeach()
install(EXPORT glidelab NAMESPACE glidelab:: FILE glidelabTargets.cmake DESTINATION ${package})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/glidelabConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_LIST_DIR}/glidelabConfig.cmake ${CMAKE_BINARY_DIR}/glidelabConfigVersion.cmake DESTINATION ${package})

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "the Glidelab maintainers <glidelab@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "rehearse and analyse video experiments on friction")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)  # what the program links to, with versions
set(CPACK_DEBIAN_PACKAGE_DEPENDS "gnuplot-nox | gnuplot, fonts-dejavu-core")
if(TARGET glidelab_python)
  # Two packages: the program with its libraries, and the module.
  set(CPACK_DEB_COMPONENT_INSTALL ON)
  set(CPACK_COMPONENTS_ALL Unspecified python)
  set(CPACK_DEBIAN_UNSPECIFIED_PACKAGE_NAME glidelab)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-glidelab)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  math(EXPR next_minor "${Python_VERSION_MINOR} + 1")
  string(CONCAT CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
         "python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}), python3 (<< ${Python_VERSION_MAJOR}.${next_minor}), "
         "python3-numpy, gnuplot-nox | gnuplot, fonts-dejavu-core")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "glidelab")  # which has the scenarios and the notebooks
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-pandas, python3-matplotlib, python3-tqdm")
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION "The Python module: import glidelab.")
endif()
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
include(CPack)
