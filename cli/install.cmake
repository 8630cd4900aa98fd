# cmake --install and cpack: the program, what it reads (library, shipped scenes, meshes, schema), manual pages, completions, documents;
# and for other CMake projects headers, libraries and find_package(crashreel).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(share ${CMAKE_INSTALL_DATADIR}/crashreel)
set(pages_folder ${CMAKE_BINARY_DIR}/share)

# what the program prints of itself
set(printed)
function(print_to file)
  add_custom_command(OUTPUT ${pages_folder}/${file} COMMAND ${CMAKE_COMMAND} -E make_directory ${pages_folder}
                     COMMAND crashreel ${ARGN} > ${pages_folder}/${file} DEPENDS crashreel VERBATIM)
  set(printed ${printed} ${pages_folder}/${file} PARENT_SCOPE)
endfunction()
set(commands render simulate plan study sample fit eval figure check compare snapshot library explain schema version man completion)
print_to(scene.schema.json schema)
print_to(crashreel.bash completion bash)
print_to(_crashreel completion zsh)
print_to(crashreel.fish completion fish)
print_to(crashreel.1 man)
set(pages crashreel.1)
foreach(command ${commands})
  print_to(crashreel-${command}.1 man ${command})
  list(APPEND pages crashreel-${command}.1)
endforeach()
# -n: no date, the same package from the same tree
foreach(page ${pages})
  add_custom_command(OUTPUT ${pages_folder}/${page}.gz COMMAND gzip -9nkf ${pages_folder}/${page} DEPENDS ${pages_folder}/${page})
  list(APPEND printed ${pages_folder}/${page}.gz)
  install(FILES ${pages_folder}/${page}.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT runtime)
endforeach()
set(contact "crashreel developers <crashreel@users.noreply.github.com>")
set(changes ${CMAKE_SOURCE_DIR}/.github/CHANGELOG.md)
add_custom_command(OUTPUT ${pages_folder}/changelog.gz
                   COMMAND ${CMAKE_SOURCE_DIR}/cli/debian_changelog ${changes} ${contact} > ${pages_folder}/changelog
                   COMMAND gzip -9nkf ${pages_folder}/changelog DEPENDS ${changes} ${CMAKE_SOURCE_DIR}/cli/debian_changelog VERBATIM)
list(APPEND printed ${pages_folder}/changelog.gz)
# what it is made of: packages that are linked, and those that no link shows
set(loaded libosmesa6)
foreach(library libavformat libavcodec libavutil)
  string(REGEX MATCH "^[0-9]+" major ${LIBAV_${library}_VERSION})
  list(APPEND loaded ${library}${major})
endforeach()
find_program(DPKG_QUERY dpkg-query)
if(DPKG_QUERY)
  set(bill ${pages_folder}/crashreel.cdx.json)
  add_custom_command(OUTPUT ${bill}
                     COMMAND ${CMAKE_SOURCE_DIR}/cli/sbom ${PROJECT_VERSION} $<TARGET_FILE:crashreel> $<TARGET_FILE:crashreel-cage> --
                             ${loaded} libeigen3-dev libcli11-dev libtomlplusplus-dev nlohmann-json3-dev libboost-dev > ${bill}.part
                     COMMAND ${CMAKE_COMMAND} -E rename ${bill}.part ${bill}
                     DEPENDS crashreel crashreel-cage ${CMAKE_SOURCE_DIR}/cli/sbom VERBATIM)
  list(APPEND printed ${bill})
  install(FILES ${bill} DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT runtime)
endif()
add_custom_target(pages ALL DEPENDS ${printed})

install(TARGETS crashreel RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT runtime)
install(DIRECTORY ${CMAKE_SOURCE_DIR}/scenes/library ${CMAKE_SOURCE_DIR}/scenes/cases ${CMAKE_SOURCE_DIR}/scenes/gallery
        DESTINATION ${share}/scenes COMPONENT runtime FILES_MATCHING PATTERN "*.toml" PATTERN "site_plan.png" PATTERN snapshots EXCLUDE)
install(DIRECTORY ${CMAKE_SOURCE_DIR}/assets/vehicles DESTINATION ${share}/assets COMPONENT runtime)
install(FILES ${pages_folder}/scene.schema.json DESTINATION ${share} COMPONENT runtime)
install(FILES ${pages_folder}/crashreel.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME crashreel COMPONENT runtime)
install(FILES ${pages_folder}/_crashreel DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT runtime)
install(FILES ${pages_folder}/crashreel.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT runtime)
install(FILES ${CMAKE_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright COMPONENT runtime)
install(FILES ${pages_folder}/changelog.gz DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT runtime)
# the guides, the pictures they show, and what they lead to
foreach(document README.md scenes/README.md scenes/GUIDE.md cli/README.md cli/inference/openturns_example.py engine/README.md tests/README.md tests/benchmark/README.md assets/SOURCES.md)
  cmake_path(GET document PARENT_PATH folder)
  install(FILES ${CMAKE_SOURCE_DIR}/${document} DESTINATION ${CMAKE_INSTALL_DOCDIR}/${folder} COMPONENT runtime)
endforeach()
install(DIRECTORY ${CMAKE_SOURCE_DIR}/assets/pictures DESTINATION ${CMAKE_INSTALL_DOCDIR}/assets COMPONENT runtime)
install(DIRECTORY ${CMAKE_SOURCE_DIR}/cli/study/pages DESTINATION ${CMAKE_INSTALL_DOCDIR}/cli/study COMPONENT runtime
        FILES_MATCHING PATTERN "*.pdf" PATTERN "*.png")
foreach(folder library cases gallery)
  set(link ${CMAKE_INSTALL_DOCDIR}/scenes/${folder})
  install(CODE "file(CREATE_LINK ../../../crashreel/scenes/${folder} \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${link}\" SYMBOLIC)" COMPONENT runtime)
endforeach()

# for other projects
install(TARGETS engine render scenes EXPORT crashreelTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
foreach(room engine render scenes)
  install(DIRECTORY ${CMAKE_SOURCE_DIR}/${room} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/crashreel COMPONENT development
          FILES_MATCHING PATTERN "*.h" PATTERN gallery EXCLUDE PATTERN cases EXCLUDE PATTERN library EXCLUDE)
endforeach()
set(config ${CMAKE_INSTALL_LIBDIR}/cmake/crashreel)
install(EXPORT crashreelTargets NAMESPACE crashreel:: DESTINATION ${config} COMPONENT development)
configure_package_config_file(${CMAKE_SOURCE_DIR}/cli/crashreelConfig.cmake.in ${CMAKE_BINARY_DIR}/crashreelConfig.cmake INSTALL_DESTINATION ${config})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/crashreelConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/crashreelConfig.cmake ${CMAKE_BINARY_DIR}/crashreelConfigVersion.cmake DESTINATION ${config} COMPONENT development)

# cpack -G DEB: the program and what it reads, not what only a compiler wants
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME crashreel)
set(CPACK_PACKAGE_VENDOR crashreel)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "reconstruct traffic accidents and show them as pictures")
set(CPACK_COMPONENT_RUNTIME_DESCRIPTION "crashreel reads a scene file with vehicles and persons, computes their motion\nand contacts, and draws films, stills, report figures and tables.\nIt runs offline and needs no graphics card.")
set(CPACK_PACKAGE_CONTACT ${contact})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL runtime)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME crashreel)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# beside what the program is linked with: what it reads, and what it loads when needed
string(JOIN ", " CPACK_DEBIAN_RUNTIME_PACKAGE_DEPENDS fonts-dejavu-core ${loaded})
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
include(CPack)
