# What Debian wants beside the installed files of each package: copyright, changelog and manual pages as it has them. CPack runs this before it
# packs.
file(GLOB folders ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/*)
foreach(folder ${folders})
  get_filename_component(component ${folder} NAME)
  string(TOUPPER ${component} component)
  set(package ${CPACK_DEBIAN_${component}_PACKAGE_NAME})
  set(documents ${folder}/usr/share/doc/${package})
  string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
  file(WRITE ${documents}/changelog
    "glocal (${CPACK_PACKAGE_VERSION}) stable; urgency=medium\n\n  * CHANGELOG.md of the sources says what is new.\n\n -- ${CPACK_PACKAGE_CONTACT}  ${date}\n")
  file(COPY_FILE ${CMAKE_CURRENT_LIST_DIR}/../../LICENSE ${documents}/copyright)
  file(MAKE_DIRECTORY ${folder}/usr/share/lintian/overrides)
  file(COPY_FILE ${CMAKE_CURRENT_LIST_DIR}/lintian-overrides ${folder}/usr/share/lintian/overrides/${package})
  file(GLOB pages ${folder}/usr/share/man/man1/*.1)
  # Without a time stamp: the same package from the same files.
  execute_process(COMMAND gzip -9n ${documents}/changelog ${pages} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
