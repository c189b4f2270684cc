# What is installed: the program, the shared libraries, the public headers, and what finds them.
include(CMakePackageConfigHelpers)
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME core)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/glocal)

install(TARGETS glocal glocal_builtin glocal_evaluation EXPORT glocal_targets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
set_target_properties(glocal_app PROPERTIES EXPORT_NAME program)
install(TARGETS glocal_app EXPORT glocal_targets RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY framework/include/glocal evaluation/include/glocal DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.hpp")
# Methods, cases and suites are found beside the library, in the build's folder too, and so is the leaderboard.
install(DIRECTORY configs leaderboard DESTINATION ${CMAKE_INSTALL_DATADIR}/glocal PATTERN README.md EXCLUDE)
file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/share/glocal)
foreach(folder configs leaderboard)
  file(CREATE_LINK ${CMAKE_SOURCE_DIR}/${folder} ${CMAKE_BINARY_DIR}/share/glocal/${folder} SYMBOLIC)
endforeach()
install(EXPORT glocal_targets FILE glocalTargets.cmake NAMESPACE glocal:: DESTINATION ${package_dir})
# The manual is made of what the program says of itself. Shells look for completions in folders of their own; these are Debian's.
set(manual ${CMAKE_BINARY_DIR}/manual)
add_custom_command(OUTPUT ${manual}/glocal.1 DEPENDS glocal_app scripts/manual_pages
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${manual} COMMAND scripts/manual_pages ${GLOCAL_PROGRAM} ${manual}
  WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
add_custom_target(manual ALL DEPENDS ${manual}/glocal.1)
install(DIRECTORY ${manual}/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
set(completions ${CMAKE_SOURCE_DIR}/app/completion)
install(FILES ${completions}/glocal.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME glocal)
install(FILES ${completions}/glocal.zsh DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions RENAME _glocal)
install(FILES ${completions}/glocal.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
# Builds what is installed, and nothing else.
get_property(package_plugins GLOBAL PROPERTY GLOCAL_PACKAGE_PLUGINS)
add_custom_target(installed DEPENDS glocal glocal_builtin glocal_evaluation glocal_app manual ${package_plugins})

install(FILES cmake/glocal_add_plugin.cmake cmake/plugin_exports.map DESTINATION ${package_dir})
# The program finds its library wherever both have been put.
file(RELATIVE_PATH lib_from_bin ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
set_target_properties(glocal_app PROPERTIES INSTALL_RPATH "$ORIGIN/${lib_from_bin}")

write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/glocalConfigVersion.cmake COMPATIBILITY SameMinorVersion)
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/glocalConfig.cmake
  "include(CMakeFindDependencyMacro)\nfind_dependency(Eigen3 3.4)\ninclude(\${CMAKE_CURRENT_LIST_DIR}/glocalTargets.cmake)\ninclude(\${CMAKE_CURRENT_LIST_DIR}/glocal_add_plugin.cmake)\n")
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/glocalConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/glocalConfigVersion.cmake
  DESTINATION ${package_dir})

# Folders that are relative to the prefix are found from where the file lies, so that an installed tree can be moved. Absolute ones stay as they are:
# appended to another path they take its place.
set(pc_prefix ${CMAKE_INSTALL_PREFIX})
if(NOT IS_ABSOLUTE "${CMAKE_INSTALL_LIBDIR}")
  file(RELATIVE_PATH libdir_to_prefix ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
  set(pc_prefix "\${pcfiledir}/${libdir_to_prefix}")
endif()
cmake_path(APPEND pc_libdir "\${prefix}" "${CMAKE_INSTALL_LIBDIR}")
cmake_path(APPEND pc_includedir "\${prefix}" "${CMAKE_INSTALL_INCLUDEDIR}")
configure_file(cmake/glocal.pc.in glocal.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/glocal.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

# A package of glocal itself, and one for each plugin of this tree that is built: who installs the first needs no PCL.
set(CPACK_GENERATOR DEB)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_CORE_PACKAGE_NAME glocal)
set(CPACK_COMPONENT_CORE_DESCRIPTION "Finds where a robot is on a known map from its scans and odometry.
The package has the program, its libraries, and what others are built with.")
# What headers include, and what draws figures.
set(CPACK_DEBIAN_CORE_PACKAGE_SUGGESTS "libeigen3-dev, python3-matplotlib")
foreach(package mrpt octomap open3d pcl ros2)
  string(TOUPPER ${package} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME glocal-${package})
  set(CPACK_DEBIAN_${upper}_PACKAGE_DEPENDS "glocal (= ${PROJECT_VERSION})")
  set(CPACK_COMPONENT_${upper}_DESCRIPTION "This package has the plugin ${package} of glocal.")
endforeach()
set(CPACK_PACKAGE_CONTACT "The glocal authors <glocal@example.org>")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_BINARY_DIR}/framework ${CMAKE_BINARY_DIR}/evaluation)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_STRIP_FILES ON)
# Which package programs depend on that are linked with the libraries.
set(control ${CMAKE_CURRENT_BINARY_DIR}/debian)
set(interface "${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} glocal (= ${PROJECT_VERSION})\n")
file(WRITE ${control}/shlibs "libglocal ${interface}libglocal_builtin ${interface}libglocal_evaluation ${interface}")
file(WRITE ${control}/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_CORE_PACKAGE_CONTROL_EXTRA ${control}/shlibs ${control}/triggers)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_SOURCE_DIR}/cmake/debian/documents.cmake)
include(CPack)
